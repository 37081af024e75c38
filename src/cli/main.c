/* The command line: the table of commands. Options are in options.c. */
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/text.h"
#include "cli/check_start.h"
#include "cli/command.h"
#include "files/build_info.h"
#include "files/checkpoint.h"
#include "files/frames_apart.h"
#include "files/hdf5.h"
#include "files/reader.h"
#include "oracle/pack.h"
#include "scene/scene.h"
#include "version.h"

#define LEAST_MEMORY ((size_t)4 << 20) /* bytes: some libraries crash when they are refused a little */

/* What was to be printed must have arrived where it went. After a failure nothing more is said. */
static enum exit_code told(enum exit_code code)
{
  const bool failure = code != EXIT_DONE && code < EXIT_CLOSE;
  if (failure || (fflush(stdout) == 0 && !ferror(stdout)))
    return code;
  fprintf(stderr, "uncross: standard output: cannot write: %s\n", strerror(errno));
  return EXIT_NOT_WRITTEN;
}

/* --- commands without a file of their own ------------------------------------------------------------------------ */

static enum exit_code check(const struct arguments *a)
{
  const struct scene_settings settings = {a->sets, a->set, a->sets};
  struct scene scene;
  struct stream stream;
  struct message message;
  const bool read = scene_read_numbers(a->file[0], &settings, &scene, &message);
  const bool ok = read && check_start(a->file[0], &settings, &scene, &stream, &message);
  if (ok)
    scene_report(&scene, &stream, a->numbers);
  else
    fprintf(stderr, "uncross: %s\n", message.text);
  if (read)
    scene_free(&scene);
  return ok ? EXIT_DONE : EXIT_BAD_INPUT;
}

static enum exit_code schema(const struct arguments *a)
{
  (a->document ? scene_document : scene_schema)(stdout);
  return EXIT_DONE;
}

static enum exit_code info(const struct arguments *a)
{
  struct message message;
  if (file_info(a->file[0], &message))
    return EXIT_DONE;
  fprintf(stderr, "uncross: %s\n", message.text);
  return message.kind == MESSAGE_NO_MEMORY ? EXIT_TROUBLE : EXIT_BAD_INPUT;
}

#define MAY(code) (1u << (code))
#define WRITES MAY(EXIT_NOT_WRITTEN)

const struct command commands[COMMANDS] = {
    [COMMAND_CHECK] = {"check", "SCENE", 1, WRITES,
                       "what a scene says, all its derived numbers, memory, time, warnings", NULL, check},
    [COMMAND_MAP] = {"map", "FIBER", 1, WRITES, "the scene of a fiber that is given in SI units (docs/units.md)",
                     "FIBER is length=10um,persistence=17um, and if known diameter=7nm, mesh=1um (of the network that "
                     "fills the\n"
                     "box), vertices=64 (in how many pieces; or a0 in --units).\n",
                     NULL},
    [COMMAND_RUN] =
        {"run", "SCENE", 1, MAY(EXIT_STOPPED) | WRITES | MAY(EXIT_INTERRUPTED), "runs a scene in a folder",
         "DIR gets checkpoint.h5, run.json, a table for each observable, and trajectory.h5 (docs/files.md).\n"
         "Nothing is written over. SIGINT (Ctrl-C), SIGTERM, SIGHUP, SIGUSR1 and SIGXCPU end the run after the step "
         "at\n"
         "hand, with a checkpoint. A second SIGINT or SIGTERM, a second later, ends it at once, without one.\n",
         command_run},
    [COMMAND_INFO] = {"info", "FILE", 1, WRITES,
                      "what a file is: scene, checkpoint, trajectory, run.json, table; or a run's folder", NULL, info},
    [COMMAND_VERIFY] = {"verify", "FILE ...", 1, WRITES | MAY(EXIT_DAMAGED),
                        "whether checkpoints, trajectories, packs, tables, folders of runs are whole",
                        "Prints a line for each file: whole, readable (what it carries no checksum of), or damaged.\n",
                        command_verify},
    [COMMAND_SCHEMA] = {"schema", "", 0, WRITES, "the JSON schema of scenes, for editors", NULL, schema},
    [COMMAND_EXPORT] = {"export", "FILE", 1, WRITES,
                        "a trajectory or checkpoint as text: extended XYZ, LAMMPS data and dump, VTF", NULL, NULL},
    [COMMAND_FRAMES] = {"frames", "FILE", 1, WRITES,
                        "frames of a trajectory or checkpoint as plain numbers, for programs (docs/files.md)",
                        "Standard input says which: the number of a frame, from 0, on each line.\n", command_frames},
    [COMMAND_LINKS] = {"links", "", 0, WRITES,
                       "crossings and Alexander's polynomials of closed polygons, for programs (docs/topology.md)",
                       "Standard input has the polygons, as plain numbers, and which of them are asked for.\n",
                       command_links},
    [COMMAND_TOPOLOGY] =
        {"topology", "FILE", 1, MAY(EXIT_CROSSED) | WRITES,
         "whether bonds crossed each other between the frames of any code's trajectory (docs/topology.md)",
         "FILE is H5MD, a LAMMPS dump, (extended) XYZ, VTF, or a checkpoint. Vertices are taken to move straight from "
         "frame\n"
         "to frame; each meeting of two bonds is decided without rounding.\n",
         NULL},
    [COMMAND_CROSSINGS] = {"crossings", "", 0, WRITES,
                           "meetings of bonds between two frames as plain numbers, for programs (docs/topology.md)",
                           "Standard input has bonds, then frames in pairs.\n", command_crossings},
    [COMMAND_ANALYZE] = {"analyze", "TRAJECTORY", 1, WRITES,
                         "the observables of a trajectory's scene from its frames, as new tables", NULL,
                         command_analyze},
    [COMMAND_PLOT] = {"plot", "FOLDER|FILE ...", 1, WRITES,
                      "a page of a run, table, trajectory or checkpoint: fibers, figures, what to distrust",
                      "One HTML file that needs no other (docs/running.md). Nothing is written over.\n", NULL},
    [COMMAND_SWEEP] =
        {"sweep", "SCENE", 1, MAY(EXIT_STOPPED) | WRITES | MAY(EXIT_INTERRUPTED),
         "runs a scene over a grid of values and seeds, and averages",
         "Each run gets a folder below DIR, as `uncross run` makes it. Then DIR gets averages over seeds of "
         "all tables,\n"
         "summary.csv with a row for each point of the grid, and runs.csv with the exit code of each run "
         "(docs/running.md).\n"
         "Nothing is written over. The exit code is the code of the first run that failed.\n",
         NULL},
    [COMMAND_ORACLE_SCHEMA] = {"oracle schema", "", 0, WRITES,
                               "the table of operators as JSON: their tables, columns, and which scenes have them",
                               NULL, oracle_schema},
    [COMMAND_EMIT] = {"oracle emit", "SCENE", 1, WRITES,
                      "inputs and outputs of every operator, at two steps, as a pack", NULL, oracle_emit_file},
    [COMMAND_START] = {"oracle start", "SCENE", 1, WRITES,
                       "what a run of the scene starts from, as a pack: for ports' traces", NULL, oracle_start_file},
    [COMMAND_TRACE] = {"oracle trace", "SCENE", 1, WRITES | MAY(EXIT_STOPPED),
                       "state hashes and sums after every stage of the scene's steps, as CSV", NULL, oracle_trace_file},
    [COMMAND_ANSWER] =
        {"oracle answer", "PACK OUT", 2, WRITES, "outputs from the inputs of a pack, as a port writes them",
         "OUT is a pack as HDF5. Answered are the operators each of whose rows stands for itself: random,\n"
         "permutation, crossing, exchange, contact_search, tube_search, tube_contact, bead_search,\n"
         "bead_contact and impulse; of thin fibers and points in a periodic box those of places too:\n"
         "sweep, long_sweep, event_drift, long_event_drift, bin, bond_force, bend_force and force.\n",
         oracle_answer_file},
    [COMMAND_DUMP] = {"oracle dump", "PACK", 1, WRITES, "a pack as text", NULL, oracle_dump_file},
    [COMMAND_COMPARE] = {"oracle compare", "OURS THEIRS", 2, WRITES | MAY(EXIT_CLOSE) | MAY(EXIT_DIFFERS),
                         "two packs, each HDF5 or text, or two traces: the first difference and what it means", NULL,
                         oracle_compare_files},
    [COMMAND_CHECK_PORT] = {"oracle check", "PORT", 1, WRITES | MAY(EXIT_CLOSE) | MAY(EXIT_DIFFERS),
                            "runs a port over all packs and traces: one table, one exit code",
                            "PORT is a program: `PORT PACK OUT` reads a pack and writes its outputs, `PORT --trace "
                            "START OUT` writes a trace\n"
                            "(docs/port/README.md). --single and --only leave the traces out.\n",
                            oracle_check_port},
    [COMMAND_JUDGE] =
        {"oracle judge", "OURS THEIRS", 2, WRITES | MAY(EXIT_DIFFERS) | MAY(EXIT_CANNOT_TELL),
         "two tables of observables (docs/judging.md): could both be the same code?",
         "OURS is reference-data/observables.csv. Averages are compared with their errors; energy and momentum must\n"
         "stay within bounds that single precision keeps. 40 blocks (wave: 320) see all that must be seen.\n",
         oracle_judge_files},
};

/* --- which one --------------------------------------------------------------------------------------------------- */

static enum exit_code dispatch(const char *program, enum command_code command, int count, char **words)
{
  struct arguments a;
  enum exit_code code = arguments_read(command, count, words, &a);
  a.program = program;
  if (code == EXIT_DONE && a.help)
    help_command(stdout, command);
  else if (code == EXIT_DONE)
    code = commands[command].act && !(command == COMMAND_CHECK && a.units) ? commands[command].act(&a)
                                                                           : outer_run(&commands[command], words);
  const bool words_matter = a.help || command != COMMAND_RUN; /* what a run is for is in its folder */
  arguments_free(&a);
  return words_matter ? told(code) : code;
}

static enum exit_code version(void)
{
  printf("uncross %s (commit %s; %s; %s)\n", UNCROSS_VERSION, build_info.commit, build_info.compiler, build_info.flags);
  return EXIT_DONE;
}

static enum exit_code cite(void)
{
  printf("@article{padding2009,\n"
         "  author = {Padding, J. T.},\n"
         "  title = {Efficient simulation of noncrossing fibers and chains in a hydrodynamic solvent},\n"
         "  journal = {The Journal of Chemical Physics},\n"
         "  volume = {130},\n  pages = {144903},\n  year = {2009},\n  doi = {10.1063/1.3105339}\n}\n"
         "@software{uncross,\n"
         "  author = {{uncross contributors}},\n"
         "  title = {uncross: noncrossing fibers and chains in a hydrodynamic solvent},\n"
         "  version = {%s, commit %s}\n}\n",
         UNCROSS_VERSION, build_info.commit);
  return EXIT_DONE;
}

/* The command of this name: "run"; or "oracle" and "emit". COMMANDS if there is none. */
static enum command_code find_command(const char *first, const char *second)
{
  char both[64];
  snprintf(both, sizeof both, "%s%s%s", first, second ? " " : "", second ? second : "");
  int command = 0;
  while (command < COMMANDS && strcmp(commands[command].name, both) != 0)
    command++;
  return (enum command_code)command;
}

static bool asks_help(const char *word)
{
  return strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0 || strcmp(word, "help") == 0;
}

static enum exit_code oracle(const char *program, int count, char **words)
{
  const char *action = count > 1 ? words[1] : "";
  if (asks_help(action)) {
    help_group(stdout, "oracle");
    return told(EXIT_DONE);
  }
  const enum command_code command = find_command("oracle", action);
  return command < COMMANDS ? dispatch(program, command, count - 1, words + 1)
                            : usage_error("oracle", "oracle: no such action: %s", action[0] ? action : "(none given)");
}

/* `uncross help [COMMAND [ACTION]]`; --man [COMMAND [ACTION]], --commands and --completion are for `make install`. */
static enum exit_code help(int count, char **words)
{
  static const struct {
    const char *word;
    void (*print)(FILE *out);
  } forms[] = {{"--man", help_man}, {"--commands", help_names}, {"--completion", help_completion}};
  const bool page = count > 2 && strcmp(words[1], "--man") == 0;
  words += page;
  count -= page;
  const char *first = count > 1 ? words[1] : NULL, *second = count > 2 ? words[2] : NULL;
  for (size_t k = 0; first && k < sizeof forms / sizeof *forms; k++)
    if (strcmp(first, forms[k].word) == 0) {
      forms[k].print(stdout);
      return EXIT_DONE;
    }
  const enum command_code command = first ? find_command(first, second) : COMMANDS;
  if (!first)
    help_all(stdout);
  else if (command < COMMANDS)
    (page ? help_man_command : help_command)(stdout, command);
  else if (strcmp(first, "oracle") == 0 && !second && !page)
    help_group(stdout, first);
  else
    return usage_error("", "unknown command %s%s%s", first, second ? " " : "", second ? second : "");
  return EXIT_DONE;
}

/* Opens /dev/null in place of standard streams that the caller has closed. Otherwise the next file that is opened would
 * get the number of such a stream, and all output to the stream would go into the file. */
static void keep_streams(void)
{
  int fd;
  do
    fd = open("/dev/null", O_RDONLY);
  while (fd >= 0 && fd <= STDERR_FILENO);
  if (fd >= 0)
    close(fd);
}

/* What this program does as a process that reads a file (files/reader.h). */
static const struct apart_work works[] = {{"checkpoint", checkpoint_serve},
                                          {"frames", frames_serve},
                                          {"sort", sort_serve},
                                          {"pack", pack_serve},
                                          {NULL, NULL}};

int main(int count, char **words)
{
  keep_streams();
  h5_own_process();
  reader_is_here(count, words, works);
  if (count < 2) {
    help_all(stderr);
    return EXIT_BAD_INPUT;
  }
  if (asks_help(words[1]))
    return told(help(count - 1, words + 1));
  if (strcmp(words[1], "--version") == 0)
    return told(version());
  if (strcmp(words[1], "--cite") == 0)
    return told(cite());
  if (strcmp(words[1], "oracle") == 0)
    return oracle(words[0], count - 1, words + 1);
  if (!memory_to_spare(LEAST_MEMORY)) {
    fprintf(stderr, "uncross: no memory: there are not %zu MiB to spare\n", LEAST_MEMORY >> 20);
    return EXIT_TROUBLE;
  }
  const enum command_code command = find_command(words[1], NULL);
  return command < COMMANDS ? dispatch(words[0], command, count - 1, words + 1)
                            : usage_error("", "unknown command %s", words[1]);
}
