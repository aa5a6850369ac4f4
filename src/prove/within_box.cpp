#include "prove/within_box.h"

namespace vantage::internal::prove {

// Cut faces are put into such planes exactly: what a file rounded is all that is allowed.
ClaimProof prove_within_box(const std::string& name, const LimitedVolume& volume, const Box& box) {
  Broken worst;
  for (const Triangle& triangle : volume.solid().triangles) {
    for (const std::uint32_t v : triangle) {
      const Vec3& at = volume.solid().vertices[v];
      worst.see((box.min - at).cwiseMax(at - box.max).maxCoeff(), at - volume.origin());
    }
  }
  if (worst.by_m > volume.rounding_m()) return volume.wrong(name, worst, "the limit");
  return proved(name, "it holds at every vertex, and what it allows is convex");
}

}  // namespace vantage::internal::prove
