/* What a collision of MPC-AT+a does to velocity and stress, averaged over the places of N particles in one cell: the
 * table in src/theory/chaos_at_plus_a.c.
 *
 * A collision replaces the velocities of a cell by their projection on rigid motions (translations and rotations), H,
 * plus noise: v' = H v + (1 - H) xi. Averaged over places that are uniform in the cell, all of mass 1 but the first:
 *
 *   kept      S = < sum_ij (H_ix,jx H_iy,jy + H_ix,jy H_iy,jx) >: a share S/N of the kinetic stress is kept
 *   handed    Q = < sum_i y_i y_i - sum_ij y_i H_ix,jx y_j >: the momentum that passes through the cell, m a0^2
 *   velocity  K = < sum_a H_1a,1a >/d: what the first keeps of its velocity
 *
 * H is made here by Gram and Schmidt from the motions themselves, not from a tensor of inertia.
 *
 * usage: rigid_share SAMPLES MASS      prints d, N, S, error, Q, error, K, error */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 64, PARTS = 20, ROWS = 6 };

static double uniform(uint64_t *state)
{
  uint64_t z = *state += 0x9e3779b97f4a7c15;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return ((double)((z ^ (z >> 31)) >> 11) + 0.5) * 0x1p-53;
}

/* Rigid motions, orthonormal in the metric of the masses; rows of [particle][axis], times the root of the mass. */
static int motions(int n, int d, double place[MOST][3], const double *mass, double row[ROWS][MOST * 3])
{
  double centre[3] = {0}, all = 0.0;
  int rows = 0;
  for (int i = 0; i < n; i++) {
    all += mass[i];
    for (int a = 0; a < d; a++)
      centre[a] += mass[i] * place[i][a];
  }
  for (int k = 0; k < (d == 3 ? 6 : 3); k++) {
    double *r = row[rows], before = 0.0, after = 0.0;
    const int a = d == 3 ? k % 3 : 0, b = d == 3 ? (k + 1) % 3 : 1;
    memset(r, 0, sizeof row[0]);
    for (int i = 0; i < n; i++) {
      const double root = sqrt(mass[i]);
      if (k < d) {
        r[3 * i + k] = root;
      } else {
        r[3 * i + a] = -root * (place[i][b] - centre[b] / all);
        r[3 * i + b] = root * (place[i][a] - centre[a] / all);
      }
    }
    for (int j = 0; j < 3 * n; j++)
      before += r[j] * r[j];
    for (int m = 0; m < 2 * rows; m++) { /* twice, for the rounding */
      double along = 0.0;
      for (int j = 0; j < 3 * n; j++)
        along += row[m % rows][j] * r[j];
      for (int j = 0; j < 3 * n; j++)
        r[j] -= along * row[m % rows][j];
    }
    for (int j = 0; j < 3 * n; j++)
      after += r[j] * r[j];
    if (!(after > 1e-20 * before))
      continue;
    for (int j = 0; j < 3 * n; j++)
      r[j] /= sqrt(after);
    rows++;
  }
  return rows;
}

/* S, Q and K of one set of places; all pairs of directions are averaged. */
static void sample(int n, int d, const double *mass, uint64_t *state, double out[3])
{
  static double place[MOST][3], row[ROWS][MOST * 3];
  for (int i = 0; i < n; i++)
    for (int a = 0; a < 3; a++)
      place[i][a] = a < d ? uniform(state) - 0.5 : 0.0;
  const int rows = motions(n, d, place, mass, row);
  double s = 0.0, q = 0.0, k = 0.0;
  for (int x = 0; x < d; x++)
    for (int y = 0; y < d; y++) {
      if (x == y)
        continue;
      for (int p = 0; p < rows; p++) {
        double moment = 0.0;
        for (int i = 0; i < n; i++)
          moment += place[i][y] * row[p][3 * i + x];
        q -= moment * moment;
        /* sum_ij (sum_p r_ix r_jx)(sum_q r_iy r_jy) = sum_pq (sum_i r_pix r_qiy)^2, and so the mixed term */
        for (int m = 0; m < rows; m++) {
          double one = 0.0, other = 0.0;
          for (int i = 0; i < n; i++) {
            one += row[p][3 * i + x] * row[m][3 * i + y];
            other += row[m][3 * i + x] * row[p][3 * i + y];
          }
          s += one * one + one * other;
        }
      }
      for (int i = 0; i < n; i++)
        q += place[i][y] * place[i][y];
    }
  for (int p = 0; p < rows; p++)
    for (int a = 0; a < d; a++)
      k += row[p][a] * row[p][a];
  out[0] = s / (d * (d - 1));
  out[1] = q / (d * (d - 1));
  out[2] = k / d;
}

int main(int argc, char **argv)
{
  const long samples = argc > 2 ? atol(argv[1]) : 0;
  const double first = argc > 2 ? atof(argv[2]) : 0.0;
  static const int numbers[] = {2, 3, 4, 5, 6, 7, 8, 10, 12, 16, 24, 32, 48};
  if (samples < PARTS || !(first > 0.0)) {
    fprintf(stderr, "usage: rigid_share SAMPLES MASS\n");
    return 2;
  }
  uint64_t state = 1;
  for (int d = 2; d <= 3; d++)
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
      const int n = numbers[k];
      double mass[MOST], sum[3] = {0}, square[3] = {0};
      for (int i = 0; i < n; i++)
        mass[i] = i == 0 ? first : 1.0;
      for (int part = 0; part < PARTS; part++) {
        double mean[3] = {0}, out[3];
        for (long m = 0; m < samples / PARTS; m++) {
          sample(n, d, mass, &state, out);
          for (int j = 0; j < 3; j++)
            mean[j] += out[j] / (double)(samples / PARTS);
        }
        for (int j = 0; j < 3; j++) {
          sum[j] += mean[j] / PARTS;
          square[j] += mean[j] * mean[j] / PARTS;
        }
      }
      printf("%d %2d", d, n);
      for (int j = 0; j < 3; j++)
        printf("  %.5f +- %.5f", sum[j], sqrt(fmax(0.0, square[j] - sum[j] * sum[j]) / (PARTS - 1)));
      printf("\n");
      fflush(stdout);
    }
  return 0;
}
