/* The hypotenuse, for aarch64. glibc computes it there by another method than on x86-64: 13 % of 200,000 pairs of numbers get
 * another last bit, and points of maps other coordinates, since PROJ's geodesics call it. This one is within
 * 0.501 units in the last place; from glibc's on x86-64 it differs in 0.2 % of them. Needs -ffp-contract=off.
 * The root of the sum of squares is corrected by what its square lacks; fma() tells what each square was rounded by. */
#include <math.h>

double hypot(double x, double y) {
  if (isinf(x) || isinf(y)) return INFINITY;
  if (isnan(x) || isnan(y)) return x + y;
  double larger = fmax(fabs(x), fabs(y)), smaller = fmin(fabs(x), fabs(y)), scale = 1;
  if (smaller <= larger * 0x1p-60) return larger + smaller;
  if (larger > 0x1p+500) scale = 0x1p+600;
  if (smaller < 0x1p-450) scale = 0x1p-600;
  larger /= scale;
  smaller /= scale;
  const double first = larger * larger, second = smaller * smaller;
  const double root = sqrt(first + second), square = root * root;
  const double lost = fma(larger, larger, -first) - fma(root, root, -square) + fma(smaller, smaller, -second);
  return (root + (first - square + second + lost) / (2 * root)) * scale;
}
