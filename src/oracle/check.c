#include "oracle/check.h"

#include <errno.h>
#include <glob.h>
#include <inttypes.h>
#include <jansson.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "oracle/called.h"
#include "oracle/name.h"
#include "version.h"

/* One pack or one trace, and how the port did. */
struct check {
  char path[PATH_MAX], name[64]; /* of ours: dense.pack, dense.trace */
  bool trace, skipped;
  char trouble[256]; /* the port failed, or wrote what cannot be read; or empty */
  struct oracle_summary summary;
  char *details; /* what compare prints; to be freed */
};

struct checks {
  const struct check_options *options;
  struct oracle_options compare; /* of the first call of the port; names are asked for in our scratch */
  char scratch[PATH_MAX - 64], folder[PATH_MAX - 64];
  struct check *check;
  size_t count;
};

/* --- where packs are --------------------------------------------------------------------------------------------- */

static bool has_packs(const char *folder)
{
  char pattern[PATH_MAX];
  glob_t found;
  snprintf(pattern, sizeof pattern, "%s/*.pack.h5", folder);
  const bool any = glob(pattern, 0, NULL, &found) == 0;
  globfree(&found);
  return any;
}

/* Beside the program: where `make install` puts packs, or in the source tree. */
static bool find_folder(struct checks *c, struct message *message)
{
  static const char *const places[] = {"/../share/uncross/reference-data", "/../reference-data"};
  char program[PATH_MAX - 128];
  if (c->options->folder) {
    snprintf(c->folder, sizeof c->folder, "%s", c->options->folder);
    return has_packs(c->folder) || message_set(message, "%s: no packs *.pack.h5", c->folder);
  }
  const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
  program[length > 0 ? length : 0] = '\0';
  char *slash = strrchr(program, '/');
  if (slash)
    *slash = '\0';
  for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
    snprintf(c->folder, sizeof c->folder, "%s%s", program, places[k]);
    if (has_packs(c->folder))
      return true;
  }
  return message_set(message, "no packs beside this program; --packs FOLDER says where they are");
}

/* Appends a check for each file of our folder with this ending, in the order of their names. */
static bool list(struct checks *c, const char *ending, bool trace)
{
  char pattern[PATH_MAX];
  glob_t found;
  snprintf(pattern, sizeof pattern, "%s/*%s", c->folder, ending);
  const int code = glob(pattern, 0, NULL, &found);
  for (size_t k = 0; code == 0 && k < found.gl_pathc; k++) {
    struct check *grown = realloc(c->check, (c->count + 1) * sizeof *grown);
    if (!grown)
      break;
    c->check = grown;
    struct check *new = &grown[c->count++];
    *new = (struct check){.trace = trace};
    snprintf(new->path, sizeof new->path, "%s", found.gl_pathv[k]);
    const char *base = strrchr(new->path, '/') ? strrchr(new->path, '/') + 1 : new->path;
    snprintf(new->name, sizeof new->name, "%.*s", (int)(strcspn(base, ".") + strlen(trace ? ".trace" : ".pack")), base);
  }
  globfree(&found);
  return code == 0 || code == GLOB_NOMATCH;
}

/* --- one of them ------------------------------------------------------------------------------------------------- */

static bool has_operator(const struct pack *pack, const char *only)
{
  char word[PACK_WORD];
  for (const char *at = only; at && *at;) {
    const size_t length = strcspn(at, ",");
    snprintf(word, sizeof word, "%.*s", (int)(length < PACK_WORD ? length : PACK_WORD - 1), at);
    for (size_t k = 0; k < pack->count; k++)
      if (strcmp(pack->table[k].place.operator_name, word) == 0)
        return true;
    at += length + (at[length] == ',');
  }
  return !only;
}

static void take_trouble(struct check *k, const struct message *message)
{
  snprintf(k->trouble, sizeof k->trouble, "%.255s", message->text);
}

static bool has_outputs(const struct pack *pack)
{
  for (size_t k = 0; k < pack->count; k++)
    if (strncmp(pack->table[k].name, "out.", 4) == 0)
      return true;
  return false;
}

/* Two traces, and what their first difference means. in: what the run starts from. */
static bool compare_traces(const char *path, const char *in, const char *out, const struct oracle_options *options,
                           FILE *details, struct oracle_summary *summary, struct message *wrong)
{
  if (!oracle_compare_traces(path, out, details, summary, wrong))
    return false;
  if (summary->verdict != ORACLE_SAME)
    oracle_name_trace(in, out, options, summary->meaning);
  if (summary->meaning[0])
    fprintf(details, "this pattern: %s\n", summary->meaning);
  return true;
}

/* A pack or a trace, and what the port has written. in: what it was given. */
static bool compare_files(const struct check *k, const char *path, const char *in, const char *out,
                          const struct oracle_options *options, FILE *details, struct oracle_summary *summary,
                          struct message *wrong)
{
  struct pack ours, theirs;
  if (k->trace)
    return compare_traces(path, in, out, options, details, summary, wrong);
  if (!pack_read(path, &ours, wrong))
    return false;
  oracle_sort(&ours);
  bool ok = pack_read(out, &theirs, wrong);
  if (ok) {
    ok = (has_outputs(&theirs) ||
          message_set(wrong, "the port has sent back what it was given: no table out. is in its pack")) &&
         oracle_align(&ours, &theirs, wrong) && oracle_compare(&ours, &theirs, options, details, summary, wrong);
    pack_free(&theirs);
  }
  pack_free(&ours);
  return ok;
}

/* Another call of the port with the same input: the same bits are wanted, whatever they are. */
static bool call_again(const struct checks *c, struct check *k, uint64_t call, const char *in, const char *first)
{
  char out[PATH_MAX];
  struct message wrong = {.text = ""};
  struct oracle_summary summary = {.verdict = ORACLE_SAME};
  struct oracle_options unnamed = c->compare;
  unnamed.namer = NULL;
  snprintf(out, sizeof out, "%s/out.%" PRIu64, c->scratch, call);
  FILE *nobody = fopen("/dev/null", "w");
  bool ok = nobody && called_port(c->options, k->trace, c->scratch, in, out, &wrong) &&
            compare_files(k, first, in, out, &unnamed, nobody, &summary, &wrong) &&
            (summary.verdict == ORACLE_SAME ||
             message_set(&wrong, "call %" PRIu64 " gives other bits than call 1: %s", call, summary.first));
  if (!ok)
    take_trouble(k, &wrong);
  if (nobody)
    fclose(nobody);
  remove(out);
  return ok;
}

static bool write_pack(const struct check_options *o, struct check *k, const char *in, struct message *message)
{
  struct pack ours;
  if (!pack_read(k->path, &ours, message))
    return false;
  called_ask(&ours);
  oracle_sort(&ours);
  k->skipped = !has_operator(&ours, o->compare.only);
  const bool ok = k->skipped || called_give(o, &ours, in, message);
  pack_free(&ours);
  return ok;
}

/* The scene of a trace stands beside it. */
static bool write_start(const struct check_options *o, struct check *k, const char *in, struct message *message)
{
  char path[PATH_MAX + 8];
  struct scene scene;
  struct pack pack;
  snprintf(path, sizeof path, "%.*s.yaml", (int)(strlen(k->path) - strlen(".trace.csv")), k->path);
  if (!scene_read(path, &scene, message))
    return false;
  const bool ok = oracle_start(&scene, &pack, message) && called_give(o, &pack, in, message);
  pack_free(&pack);
  scene_free(&scene);
  return ok;
}

static void call_port(const struct checks *c, struct check *k, const char *in, FILE *details)
{
  char out[PATH_MAX];
  struct message wrong = {.text = ""};
  snprintf(out, sizeof out, "%s/out.1", c->scratch);
  bool ok = called_port(c->options, k->trace, c->scratch, in, out, &wrong) &&
            compare_files(k, k->path, in, out, &c->compare, details, &k->summary, &wrong);
  if (!ok)
    take_trouble(k, &wrong);
  for (uint64_t call = 2; ok && call <= c->options->repeat; call++)
    ok = call_again(c, k, call, in, out);
  remove(out);
}

/* Its name is printed before the port runs. */
static bool check_one(const struct checks *c, struct check *k, FILE *out, struct message *message)
{
  char in[PATH_MAX];
  size_t size;
  snprintf(in, sizeof in, "%s/in.%s", c->scratch, c->options->text ? "txt" : "h5");
  FILE *details = open_memstream(&k->details, &size);
  if (!details)
    return message_set(message, "memory is short");
  const bool ok = (k->trace ? write_start : write_pack)(c->options, k, in, message);
  if (ok && !k->skipped) {
    fprintf(out, "%-20s ", k->name);
    fflush(out);
    call_port(c, k, in, details);
  }
  fclose(details);
  if (k->trouble[0])
    k->summary.verdict = ORACLE_DIFFERS;
  remove(in);
  return ok;
}

/* --- table and report -------------------------------------------------------------------------------------------- */

static const char *word_of(const struct check *k)
{
  static const char *const words[] = {[ORACLE_SAME] = "same", [ORACLE_CLOSE] = "close", [ORACLE_DIFFERS] = "differs"};
  return k->skipped ? "-" : k->trouble[0] ? "failed" : words[k->summary.verdict];
}

/* After its name. */
static void print_row(const struct check *k, FILE *out)
{
  const struct oracle_summary *s = &k->summary;
  if (k->skipped)
    return;
  fprintf(out, "%8" PRIu64 " %8" PRIu64 " %8" PRIu64 "  ", s->values, s->different, s->beyond);
  if (s->largest > 0.0)
    fprintf(out, "%9.2g", s->largest);
  else
    fprintf(out, "%9s", "-");
  fprintf(out, "  %s%s%s\n", word_of(k), k->trouble[0] ? ": " : "", k->trouble);
}

/* Of what differs; where a trace does, of packs that are close, too: they may be why. */
static void print_details(const struct checks *c, FILE *out)
{
  enum oracle_verdict least = ORACLE_DIFFERS;
  for (size_t k = 0; k < c->count; k++)
    if (c->check[k].trace && c->check[k].summary.verdict == ORACLE_DIFFERS)
      least = ORACLE_CLOSE;
  for (size_t k = 0; k < c->count; k++)
    if (c->check[k].summary.verdict >= least && !c->check[k].trouble[0])
      fprintf(out, "\n%s\n%s", c->check[k].name, c->check[k].details);
    else if (c->check[k].summary.verdict == ORACLE_CLOSE && c->check[k].summary.meaning[0])
      fprintf(out, "\n%s, close: %s: %s\n", c->check[k].name, c->check[k].summary.first, c->check[k].summary.meaning);
}

static json_t *json_of(const struct check *k)
{
  const struct oracle_summary *s = &k->summary;
  json_t *o = json_pack("{s:s, s:s, s:s, s:I, s:I, s:I, s:I, s:f}", "name", k->name, "kind",
                        k->trace ? "trace" : "pack", "verdict", word_of(k), "values", (json_int_t)s->values,
                        "different", (json_int_t)s->different, "beyond_tolerance", (json_int_t)s->beyond, "not_judged",
                        (json_int_t)s->unjudged, "largest_over_tolerance", s->largest);
  if (o && s->first[0])
    json_object_set_new(o, "first_difference", json_string(s->first));
  if (o && s->meaning[0])
    json_object_set_new(o, "pattern", json_string(s->meaning));
  if (o && k->trouble[0])
    json_object_set_new(o, "trouble", json_string(k->trouble));
  return o;
}

static bool write_report(const struct checks *c, enum oracle_verdict verdict, struct message *message)
{
  static const char *const words[] = {[ORACLE_SAME] = "same", [ORACLE_CLOSE] = "close", [ORACLE_DIFFERS] = "differs"};
  const struct check_options *o = c->options;
  if (!o->report)
    return true;
  json_t *all = json_array();
  for (size_t k = 0; k < c->count; k++)
    if (!c->check[k].skipped)
      json_array_append_new(all, json_of(&c->check[k]));
  json_t *root = json_pack("{s:s, s:s, s:b, s:s, s:o}", "uncross", UNCROSS_VERSION, "port", o->port, "single",
                           o->compare.single, "verdict", words[verdict], "checks", all);
  FILE *out = fopen(o->report, "wx");
  bool ok = out && root && json_dumpf(root, out, JSON_INDENT(2)) == 0 && fputc('\n', out) != EOF;
  ok = out && fclose(out) == 0 && ok;
  json_decref(root);
  return ok || message_set(message, "%s: cannot write: %s", o->report, strerror(errno));
}

static enum oracle_verdict worst_of(const struct checks *c, size_t counts[ORACLE_DIFFERS + 1])
{
  enum oracle_verdict worst = ORACLE_SAME;
  for (size_t k = 0; k < c->count; k++) {
    const struct check *one = &c->check[k];
    if (one->skipped)
      continue;
    counts[one->summary.verdict]++;
    worst = one->summary.verdict > worst ? one->summary.verdict : worst;
  }
  return worst;
}

/* Of how many values the tolerance says nothing. */
static void print_unjudged(const struct checks *c, FILE *out)
{
  uint64_t values = 0, unjudged = 0;
  for (size_t k = 0; k < c->count; k++) {
    values += c->check[k].trace ? 0 : c->check[k].summary.values;
    unjudged += c->check[k].summary.unjudged;
  }
  if (values > 0)
    fprintf(out,
            "not judged: %" PRIu64 " of %" PRIu64
            " values of packs, %.2g %%: their tolerance is not below the largest size in "
            "their table\n",
            unjudged, values, 100.0 * (double)unjudged / (double)values);
}

static bool run_all(struct checks *c, FILE *out, enum oracle_verdict *verdict, struct message *message)
{
  size_t counts[ORACLE_DIFFERS + 1] = {0};
  fprintf(out, "%-20s %8s %8s %8s  %9s  %s\n", "pack or trace", "values", "differ", "beyond", "of toler.", "verdict");
  for (size_t k = 0; k < c->count; k++) {
    if (!check_one(c, &c->check[k], out, message))
      return false;
    print_row(&c->check[k], out);
    fflush(out);
  }
  *verdict = worst_of(c, counts);
  if (counts[0] + counts[1] + counts[2] == 0)
    return message_set(message, "nothing to compare; --only takes names of operators of the packs, commas between");
  print_details(c, out);
  fprintf(out, "\nsame %zu, close %zu, different %zu\n", counts[ORACLE_SAME], counts[ORACLE_CLOSE],
          counts[ORACLE_DIFFERS]);
  print_unjudged(c, out);
  return write_report(c, *verdict, message);
}

bool oracle_check(const struct check_options *o, FILE *out, enum oracle_verdict *verdict, struct message *message)
{
  struct checks c = {.options = o, .compare = o->compare};
  const char *temporary = getenv("TMPDIR");
  if (strchr(o->port, '/') && access(o->port, X_OK) != 0)
    return message_set(message, "%s: cannot be run: %s", o->port, strerror(errno));
  if (o->report && access(o->report, F_OK) == 0)
    return message_set(message, "%s: cannot create: %s", o->report, strerror(EEXIST));
  if (!find_folder(&c, message))
    return false;
  snprintf(c.scratch, sizeof c.scratch, "%s/uncross-check.XXXXXX", temporary && temporary[0] ? temporary : "/tmp");
  if (!mkdtemp(c.scratch))
    return message_set(message, "%s: cannot create: %s", c.scratch, strerror(errno));
  c.compare.scratch = c.scratch;
  const bool traces = !o->no_traces && !o->compare.single && !o->compare.only;
  bool ok = list(&c, ".pack.h5", false) && (!traces || list(&c, ".trace.csv", true));
  ok = ok ? run_all(&c, out, verdict, message) : message_set(message, "%s: cannot be listed", c.folder);
  for (size_t k = 0; k < c.count; k++)
    free(c.check[k].details);
  free(c.check);
  called_clean(c.scratch);
  return ok;
}
