#include "exact.h"

#include <cmath>
#include <limits>

namespace attack {
namespace {

/// A number as a sum of doubles that do not overlap, the smallest first. Never rounded.
class Expansion {
 public:
  Expansion() = default;
  explicit Expansion(double value) {
    if (value != 0) parts_[size_++] = value;
  }

  static Expansion difference(double a, double b) {
    const double sum = a - b, back = a - sum;
    const double tail = (a - (sum + back)) + (back - b);
    Expansion result(tail);
    if (sum != 0) result.parts_[result.size_++] = sum;
    return result;
  }

  Expansion operator-() const {
    Expansion result = *this;
    for (int i = 0; i < size_; ++i) result.parts_[i] = -parts_[i];
    return result;
  }
  Expansion operator+(const Expansion& other) const;
  Expansion operator-(const Expansion& other) const { return *this + -other; }
  Expansion operator*(const Expansion& other) const {
    Expansion result;
    for (int i = 0; i < other.size_; ++i) result = result + scaled(other.parts_[i]);
    return result;
  }

  int sign() const { return size_ == 0 ? 0 : (parts_[size_ - 1] > 0 ? 1 : -1); }

 private:
  static constexpr int kMostParts = 224;  // three products of three differences: 3 * 64

  Expansion scaled(double factor) const;
  void append(double part) {
    if (part != 0) parts_[size_++] = part;
  }

  int size_ = 0;
  std::array<double, kMostParts> parts_;  // NOLINT: the first size_ are set

 public:
  Expansion(const Expansion& other) : size_(other.size_) {
    for (int i = 0; i < size_; ++i) parts_[i] = other.parts_[i];
  }
  Expansion& operator=(const Expansion& other) {
    size_ = other.size_;
    for (int i = 0; i < size_; ++i) parts_[i] = other.parts_[i];
    return *this;
  }
};

struct Pair {
  double high, low;
};

Pair two_sum(double a, double b) {
  const double sum = a + b, virtual_b = sum - a, virtual_a = sum - virtual_b;
  return {sum, (a - virtual_a) + (b - virtual_b)};
}

Pair two_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

// Every part of the smaller number in turn is carried through the other: slower than merging, and right for all inputs.
Expansion Expansion::operator+(const Expansion& other) const {
  if (size_ < other.size_) return other + *this;
  Expansion result = *this;
  for (int i = 0; i < other.size_; ++i) {
    double carry = other.parts_[i];
    Expansion next;
    for (int k = 0; k < result.size_; ++k) {
      const Pair sum = two_sum(carry, result.parts_[k]);
      next.append(sum.low);
      carry = sum.high;
    }
    next.append(carry);
    result = next;
  }
  return result;
}

Expansion Expansion::scaled(double factor) const {
  Expansion result;
  for (int i = 0; i < size_; ++i) {
    const Pair product = two_product(parts_[i], factor);
    Expansion term(product.low);
    term.append(product.high);
    result = result + term;
  }
  return result;
}

using ExactVector = std::array<Expansion, 3>;

ExactVector difference(const Vec3& a, const Vec3& b) {
  return {Expansion::difference(a.x(), b.x()), Expansion::difference(a.y(), b.y()),
          Expansion::difference(a.z(), b.z())};
}

Expansion minor(const ExactVector& u, const ExactVector& v, int i, int j) { return u[i] * v[j] - u[j] * v[i]; }

int exact_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const ExactVector u = difference(b, a), v = difference(c, a), w = difference(d, a);
  return (minor(u, v, 1, 2) * w[0] + minor(u, v, 2, 0) * w[1] + minor(u, v, 0, 1) * w[2]).sign();
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
  return (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] - Expansion(length) * Expansion(length)).sign();
}

}  // namespace attack
