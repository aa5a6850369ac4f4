#include "exact.h"

#include <cmath>
#include <limits>

namespace attack {
namespace {

struct Pair {
  double high, low;
};

Pair two_sum(double a, double b) {
  const double sum = a + b, virtual_b = sum - a, virtual_a = sum - virtual_b;
  return {sum, (a - virtual_a) + (b - virtual_b)};
}

/// Where |a| >= |b|.
Pair fast_two_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

Pair two_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

/// A number as a sum of at most `kMost` doubles that do not overlap, the smallest first. Never rounded.
template <int kMost>
struct Expansion {
  int size = 0;
  double parts[kMost];  // the first `size` are set

  Expansion() {}  // NOLINT: the array stays as it is
  void append(double part) {
    if (part != 0) parts[size++] = part;
  }
  int sign() const { return size == 0 ? 0 : (parts[size - 1] > 0 ? 1 : -1); }
};

Expansion<2> difference(double a, double b) {
  const Pair sum = two_sum(a, -b);
  Expansion<2> result;
  result.append(sum.low);
  result.append(sum.high);
  return result;
}

/// Shewchuk's fast expansion sum: the parts of both by size, then carried upwards. `sign`: of the second.
template <int m, int n>
Expansion<m + n> sum(const Expansion<m>& a, const Expansion<n>& b, double sign = 1) {
  Expansion<m + n> result;
  int i = 0, k = 0;
  const auto next = [&] {
    if (k >= b.size || (i < a.size && std::abs(a.parts[i]) < std::abs(b.parts[k]))) return a.parts[i++];
    return sign * b.parts[k++];
  };
  const int count = a.size + b.size;
  if (count == 0) return result;
  double carry = next();
  for (int taken = 1; taken < count; ++taken) {
    const double part = next();
    const Pair both = taken == 1 ? fast_two_sum(part, carry) : two_sum(carry, part);
    result.append(both.low);
    carry = both.high;
  }
  result.append(carry);
  return result;
}

/// Shewchuk's scale expansion.
template <int m>
Expansion<2 * m> product(const Expansion<m>& a, double factor) {
  Expansion<2 * m> result;
  if (a.size == 0 || factor == 0) return result;
  Pair carry = two_product(a.parts[0], factor);
  result.append(carry.low);
  for (int i = 1; i < a.size; ++i) {
    const Pair term = two_product(a.parts[i], factor);
    const Pair low = two_sum(carry.high, term.low);
    result.append(low.low);
    carry = fast_two_sum(term.high, low.high);
    result.append(carry.low);
  }
  result.append(carry.high);
  return result;
}

template <int m>
Expansion<4 * m> product(const Expansion<m>& a, const Expansion<2>& b) {
  if (b.size < 2) return sum(product(a, b.size == 1 ? b.parts[0] : 0.0), Expansion<2 * m>());
  return sum(product(a, b.parts[0]), product(a, b.parts[1]));
}

using ExactVector = std::array<Expansion<2>, 3>;

ExactVector difference(const Vec3& a, const Vec3& b) {
  return {difference(a.x(), b.x()), difference(a.y(), b.y()), difference(a.z(), b.z())};
}

Expansion<16> minor(const ExactVector& u, const ExactVector& v, int i, int j) {
  return sum(product(u[i], v[j]), product(u[j], v[i]), -1);
}

int exact_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const ExactVector u = difference(b, a), v = difference(c, a), w = difference(d, a);
  return sum(sum(product(minor(u, v, 1, 2), w[0]), product(minor(u, v, 2, 0), w[1])), product(minor(u, v, 0, 1), w[2]))
      .sign();
}

}  // namespace

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double ux = b.x() - a.x(), uy = b.y() - a.y(), uz = b.z() - a.z();
  const double vx = c.x() - a.x(), vy = c.y() - a.y(), vz = c.z() - a.z();
  const double wx = d.x() - a.x(), wy = d.y() - a.y(), wz = d.z() - a.z();
  const double yz = uy * vz, zy = uz * vy, zx = uz * vx, xz = ux * vz, xy = ux * vy, yx = uy * vx;
  const double value = (yz - zy) * wx + (zx - xz) * wy + (xy - yx) * wz;
  const double size = (std::abs(yz) + std::abs(zy)) * std::abs(wx) + (std::abs(zx) + std::abs(xz)) * std::abs(wy) +
                      (std::abs(xy) + std::abs(yx)) * std::abs(wz);
  constexpr double kHalfUlp = 0.5 * std::numeric_limits<double>::epsilon();
  constexpr double kBound = (7 + 56 * kHalfUlp) * kHalfUlp;  // Shewchuk's bound for the first stage
  if (value > kBound * size) return 1;
  if (value < -kBound * size) return -1;
  if (size == 0) return 0;
  return exact_orientation(a, b, c, d);
}

bool collinear(const Vec3& a, const Vec3& b, const Vec3& c) {
  const ExactVector u = difference(b, a), v = difference(c, a);
  return minor(u, v, 1, 2).sign() == 0 && minor(u, v, 2, 0).sign() == 0 && minor(u, v, 0, 1).sign() == 0;
}

int compare_distance(const Vec3& a, const Vec3& b, double length) {
  const ExactVector d = difference(a, b);
  Expansion<2> reach;
  reach.append(length);
  const auto squares = sum(sum(product(d[0], d[0]), product(d[1], d[1])), product(d[2], d[2]));
  return sum(squares, product(reach, reach), -1).sign();
}

}  // namespace attack
