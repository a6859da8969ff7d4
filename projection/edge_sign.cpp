#include "projection/edge_sign.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace tessera::projection {
namespace {

/// A sum of doubles without rounding: components do not overlap and grow in magnitude, so the last one has the sum's
/// sign.
class ExactSum {
 public:
  void add(double value) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const double sum = value + parts_[i];
      const double back = sum - value;
      const double rest = (value - (sum - back)) + (parts_[i] - back);  // Knuth's two-sum
      if (rest != 0) parts_[kept++] = rest;
      value = sum;
    }
    if (value != 0) parts_[kept++] = value;
    size_ = kept;
  }

  void add_product(double a, double b) {
    const double product = a * b;
    add(product);
    add(std::fma(a, b, -product));
  }

  void add_product(double a, double b, double c) {
    const double product = a * b;
    add_product(product, c);
    add_product(std::fma(a, b, -product), c);
  }

  [[nodiscard]] int sign() const { return size_ == 0 ? 0 : (parts_[size_ - 1] > 0 ? 1 : -1); }

 private:
  // 4 triple products of 4 terms and 2 products of 2: at most 20 components.
  std::array<double, 24> parts_{};
  std::size_t size_ = 0;
};

/// Sign of a * d - b * c.
int sign_2x2(double a, double b, double c, double d) {
  ExactSum sum;
  sum.add_product(a, d);
  sum.add_product(-b, c);
  return sum.sign();
}

}  // namespace

int edge_sign(const PixelVertex& from, const PixelVertex& to, double px, double py, bool* on_edge) {
  const HomogeneousVertex a = scaled_to_sign(from), b = scaled_to_sign(to);
  ExactSum sum;
  sum.add_product(a.x, b.y);
  sum.add_product(-a.y, b.x);
  sum.add_product(a.y, b.w, px);
  sum.add_product(-a.w, b.y, px);
  sum.add_product(a.w, b.x, py);
  sum.add_product(-a.x, b.w, py);
  if (const int sign = sum.sign(); sign != 0) return sign;
  if (on_edge != nullptr) *on_edge = true;
  if (const int along_x = sign_2x2(a.y, a.w, b.y, b.w); along_x != 0) return along_x;
  return sign_2x2(a.w, a.x, b.w, b.x);
}

}  // namespace tessera::projection
