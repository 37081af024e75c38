/* The solvent in a sheared box, made with one thing changed; and the thermostat of layers. */
#include "mpc/cell.h"
#include "oracle/relations.h"
#include "oracle/relations_flow.h"

/* --- images of a sheared box -------------------------------------------------------------------------------------- */

struct slide_twist {
  double offset, speed; /* times, less 1 */
  bool by_place;        /* who enters: without the grid's shift */
  bool all;             /* everybody */
  bool unfolded;
  const char *text;
};

/* Of enter and leave (sign -1, +1), and of streaming (-1, with images of either side). */
static double slide_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct slide_twist *t = twist;
  const char *name = part->pair.ours->place.operator_name;
  const bool streams = strcmp(name, "shear_stream") == 0, velocity = is_table(part, "out.velocity");
  const double sign = strcmp(name, "leave") == 0 ? 1.0 : -1.0;
  struct box box;
  if (!oracle_box(&part->pair, &box) || column > 2)
    return NAN;
  const double height = (double)box.edge[1], edge = (double)box.edge[column];
  double x = in(part, "in.position", row, column), y = in(part, "in.position", row, 1),
         v = in(part, "in.velocity", row, column), image = 0.0;
  if (streams) {
    const double time = in(part, "in.time", 0, 0), a = of_model(part, "in.reals", 0, 3 + column);
    x += rint((v * time + 0.5 * a * time * time) * LATTICE_PER_A0);
    y += rint(in(part, "in.velocity", row, 1) * time * LATTICE_PER_A0);
    v += a * time;
    image = floor(y / height);
  } else {
    image = t->all || y + (t->by_place ? 0.0 : in(part, "in.shift", 0, 1)) >= height ? 1.0 : 0.0;
  }
  if (column == 1)
    return velocity ? v : streams ? y - image * height : x;
  if (column == 2)
    return velocity ? v : x - edge * floor(x / edge);
  if (velocity)
    return v + sign * image * (1.0 + t->speed) * in(part, "in.speed", 0, 0);
  x += sign * image * (1.0 + t->offset) * in(part, "in.offset", 0, 0);
  return t->unfolded ? x : x - edge * floor(x / edge);
}

static bool slides(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct slide_twist known[] = {
      {.speed = -1.0, .text = "momentum jump ignored: images beyond the sheared boundary have another velocity"},
      {.speed = -2.0, .text = "sign of the velocity of images beyond the sheared boundary"},
      {.speed = 1.0, .text = "twice the velocity of images beyond the sheared boundary"},
      {.speed = -0.5, .text = "half of the velocity of images beyond the sheared boundary"},
      {.offset = -1.0, .text = "offset ignored: images beyond the sheared boundary have slid along x"},
      {.offset = -2.0, .text = "sign of the offset of images beyond the sheared boundary"},
      {.offset = 1.0, .text = "twice the offset of images beyond the sheared boundary"},
      {.unfolded = true, .text = "not folded along x after the change of image"},
      {.by_place = true, .text = "who takes part as its image: y + shift >= L counts, not y"},
      {.all = true, .text = "all particles change their image: those with y + shift >= L do"},
  };
  return k < COUNT_OF(known) && make(e, slide_value, &known[k], known[k].text, text);
}

/* --- the affine force --------------------------------------------------------------------------------------------- */

struct affine_twist {
  double factor, middle; /* less 1; of the height from which y counts */
  const char *text;
};

static double affine_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct affine_twist *t = twist;
  struct box box;
  if (!oracle_box(&part->pair, &box))
    return NAN;
  const double height = in(part, "in.position", row, 1) - (0.5 + t->middle) * (double)box.edge[1];
  const double kick = height * LATTICE_UNIT * in(part, "in.change", 0, 0) * (1.0 + t->factor);
  return in(part, "in.velocity", row, column) + (column == 0 ? kick : 0.0);
}

static bool affine_kicks(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct affine_twist known[] = {
      {.factor = -2.0, .text = "sign of the affine kick"},
      {.factor = -0.5, .text = "half of the affine kick"},
      {.factor = 1.0, .text = "twice the affine kick"},
      {.middle = -0.5, .text = "the affine kick from y = 0: it is from the middle of the box"},
      {.middle = 0.5, .text = "the affine kick from y = L: it is from the middle of the box"},
  };
  return k < COUNT_OF(known) && make(e, affine_value, &known[k], known[k].text, text);
}

/* --- layers ------------------------------------------------------------------------------------------------------- */

struct layer_twist {
  int axis;        /* 1 + axis of the layers; 0: y */
  bool whole;      /* one layer */
  double per_cell; /* more than 3 (N - 1) */
  bool real_only;  /* virtual ones give nothing back */
  bool all_factors, inverted, no_root;
  const char *text;
};

static uint32_t layer_of(const struct layer_twist *t, const struct box *box, uint32_t ry, uint32_t cell)
{
  const uint32_t lx = (uint32_t)box->cells[0];
  const int axis = t->axis == 0 ? 1 : t->axis - 1;
  return t->whole ? 0 : axis == 0 ? cell % lx : axis == 1 ? cell / lx % ry : cell / lx / ry;
}

static bool make_layers(const struct evidence_part *part, const void *twist, double *guess)
{
  const struct layer_twist *t = twist;
  const struct pack_table *load = oracle_sibling(&part->pair, "in.load");
  const struct pack_table *energy = oracle_sibling(&part->pair, "out.relative");
  struct box box;
  if (!load || !energy || load->rows != part->rows || energy->rows != part->rows || !oracle_box(&part->pair, &box))
    return false;
  const uint32_t ry = part->rows / (uint32_t)(box.cells[0] * box.cells[2]);
  const bool walls = ry > (uint32_t)box.cells[1];
  for (uint32_t cell = 0; ry > 0 && cell < part->rows; cell++) {
    double wanted = 0.0, present = 0.0;
    for (uint32_t k = 0; k < part->rows; k++) {
      const double n = at(load, k, 0), mass = at(load, k, 1) * CELL_MASS_UNIT;
      const int64_t cut = walls ? cut_of(&box, k) : -1;
      const double number = cut < 0 ? 0.0 : in(part, "in.filled", (uint32_t)cut, 0);
      if (n < 2.0 || layer_of(t, &box, ry, k) != layer_of(t, &box, ry, cell))
        continue;
      wanted += 3.0 * (n - 1.0 - (number > 0.0 && !t->real_only ? (mass - number) / mass : 0.0)) + t->per_cell;
      present += at(energy, k, 0) * 0x1p-32;
    }
    const double ratio = t->inverted ? present / wanted : wanted / present;
    const double factor = present > 0.0 ? (t->no_root ? ratio : sqrt(ratio)) : 1.0;
    guess[cell] = at(load, cell, 0) >= 2.0 || t->all_factors ? factor : 1.0;
  }
  return true;
}

static bool layers(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct layer_twist known[] = {
      {.whole = true, .text = "one factor for all cells: rescale-layers has one for each row along y"},
      {.axis = 1, .text = "layers along x: they are rows along y"},
      {.axis = 3, .text = "layers along z: they are rows along y"},
      {.per_cell = 3.0, .text = "3 N degrees of freedom for 3 (N - 1)"},
      {.real_only = true, .text = "virtual particles are left out of the degrees of freedom: 3 N (1 - 1/(N + n))"},
      {.all_factors = true, .text = "the factor in cells that are not active, too: it is 1 there"},
      {.inverted = true, .text = "the factor inverted: root of present over wanted"},
      {.no_root = true, .text = "the factor without its root"},
  };
  if (k >= COUNT_OF(known))
    return false;
  relation_fill_tables(e, make_layers, &known[k]);
  return relation_say(text, "%s", known[k].text);
}

const struct relation oracle_relations_shear[] = {
    {"shear_stream", NULL, slides, false},
    {"enter", NULL, slides, false},
    {"leave", NULL, slides, false},
    {"affine_kick", NULL, affine_kicks, false},
    {"rescale_layers", "out.factor", layers, false},
    {.make = NULL},
};
