# A run as a task of a Slurm job array: `run_task NAME COMMAND ...`. validation/slurm/campaign.sbatch reads this file, and
# `uncross sweep --slurm` writes it into its script.
#
# USR1 (before the time is up, or `scancel --batch --signal=USR1 JOB_TASK`): the run writes its checkpoint, then the task
# is requeued, and goes on from there. TERM (scancel, preemption): the checkpoint is written, and whoever sent the signal
# decides what comes next.
run_task() {
  local name=$1 requeue=no again=no child="" code
  shift
  trap 'again=yes requeue=yes; kill -TERM "$child" 2>/dev/null' USR1
  trap 'again=yes; kill -TERM "$child" 2>/dev/null' TERM
  echo "== $name, start number $((${SLURM_RESTART_COUNT:-0} + 1))"
  "$@" &
  child=$!
  # A signal ends `wait` early, and not with the run's exit code: it is asked again.
  while
    again=no
    wait "$child"
    code=$?
    [ "$again" = yes ]
  do :; done
  # 5: checkpoint written, not finished; 143: the signal came before the run had begun.
  if [ "$requeue" = yes ] && { [ "$code" = 5 ] || [ "$code" = 143 ]; }; then
    echo "== $name is requeued"
    scontrol requeue "${SLURM_ARRAY_JOB_ID}_${SLURM_ARRAY_TASK_ID}"
    sleep 60 # until Slurm ends this
  fi
  return "$code"
}
