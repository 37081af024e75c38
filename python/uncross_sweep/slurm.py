"""The runs of a sweep as a Slurm job array: one script, which holds them all."""
import pathlib

from . import escape

HEAD = """#!/bin/bash
# Runs of {out}, a task for each; written by `uncross sweep --slurm`. Submit it with sbatch, whose options override these
# lines: `sbatch --time=2:00:00 --array=0-{last}%64 SCRIPT`. Submit it again at any time: runs that were begun go on.
#SBATCH --job-name=uncross-sweep
#SBATCH --array=0-{last}
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --mem=2G
#SBATCH --time=24:00:00
#SBATCH --signal=B:USR1@300
#SBATCH --requeue
#SBATCH --open-mode=append
set -uo pipefail
cd {here} || exit 1

"""
CHOICE = """case $SLURM_ARRAY_TASK_ID in
{lines}  *) echo "no task $SLURM_ARRAY_TASK_ID" >&2; exit 1 ;;
esac
[ ! -e "$folder/checkpoint.h5" ] || set -- "$@" --resume
mkdir -p "$(dirname "$folder")"

"""
TAIL = """
run_task "$folder" "$@"
"""


def script(runs, out):
    lines = "".join(f"  {k}) folder={escape.word(escape.path(run.folder))}; set -- {run.words()} ;;\n" for k, run in enumerate(runs))
    task = (pathlib.Path(__file__).parent / "task.sh").read_text()
    return (HEAD.format(out=escape.shown(out), last=len(runs) - 1, here=escape.word(str(pathlib.Path.cwd()))) +
            CHOICE.format(lines=lines) + task + TAIL)
