/* What clang calls by itself on x86-64 and glibc lacks. zig has these in its compiler-rt, one object that also has sin, cos,
 * exp, log and memcpy of its own, which would take the place of glibc's: volumes of maps then differ in their last digits
 * from those of the program that other compilers build. With this, linked before it, nothing is taken from it.
 * None of these may divide 128-bit integers or multiply complex numbers by an operator: it would call itself. */
#include <math.h>

typedef unsigned __int128 u128;
typedef double _Complex complex_double;

u128 __udivti3(u128 dividend, u128 divisor) {
  const u128 small = ~0ull;
  if (dividend <= small && divisor <= small) return (unsigned long long)dividend / (unsigned long long)divisor;
  u128 quotient = 0, rest = 0;
  for (int bit = 127; bit >= 0; --bit) {
    const int carry = (int)(rest >> 127);
    rest = rest << 1 | (dividend >> bit & 1);
    if (carry || rest >= divisor) {
      rest -= divisor;
      quotient |= (u128)1 << bit;
    }
  }
  return quotient;
}

__int128 __divti3(__int128 dividend, __int128 divisor) {
  const u128 size = __udivti3(dividend < 0 ? -(u128)dividend : (u128)dividend, divisor < 0 ? -(u128)divisor : (u128)divisor);
  return (__int128)((dividend < 0) != (divisor < 0) ? -size : size);
}

static complex_double made(double real, double imaginary) {
  complex_double value;
  __real__ value = real;
  __imag__ value = imaginary;
  return value;
}

static double unit_or_zero(double value) { return copysign(isinf(value) ? 1.0 : 0.0, value); }

/* (a + ib)(c + id); infinite where one factor is (C11, annex G.5.1). */
complex_double __muldc3(double a, double b, double c, double d) {
  const double real = a * c - b * d, imaginary = a * d + b * c;
  if (!isnan(real) || !isnan(imaginary)) return made(real, imaginary);
  const int first = isinf(a) || isinf(b), second = isinf(c) || isinf(d);
  if (!first && !second) return made(real, imaginary);
  if (first) a = unit_or_zero(a), b = unit_or_zero(b);
  if (second) c = unit_or_zero(c), d = unit_or_zero(d);
  if (isnan(a)) a = 0;
  if (isnan(b)) b = 0;
  if (isnan(c)) c = 0;
  if (isnan(d)) d = 0;
  return made(INFINITY * (a * c - b * d), INFINITY * (a * d + b * c));
}

/* (a + ib) / (c + id), scaled so that the divisor's square neither overflows nor vanishes. */
complex_double __divdc3(double a, double b, double c, double d) {
  const double largest = fmax(fabs(c), fabs(d));
  int power = 0;
  if (isfinite(largest) && largest > 0) {
    power = ilogb(largest);
    c = scalbn(c, -power);
    d = scalbn(d, -power);
  }
  const double square = c * c + d * d;
  const double real = scalbn((a * c + b * d) / square, -power), imaginary = scalbn((b * c - a * d) / square, -power);
  if (!isnan(real) || !isnan(imaginary)) return made(real, imaginary);
  if (square == 0 && (!isnan(a) || !isnan(b))) return made(copysign(INFINITY, c) * a, copysign(INFINITY, c) * b);
  if ((isinf(a) || isinf(b)) && isfinite(c) && isfinite(d)) {
    a = unit_or_zero(a), b = unit_or_zero(b);
    return made(INFINITY * (a * c + b * d), INFINITY * (b * c - a * d));
  }
  if (isinf(largest) && isfinite(a) && isfinite(b)) {
    c = unit_or_zero(c), d = unit_or_zero(d);
    return made(0.0 * (a * c + b * d), 0.0 * (b * c - a * d));
  }
  return made(real, imaginary);
}
