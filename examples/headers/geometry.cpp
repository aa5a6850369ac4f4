// The middle of what a mesh takes up.
#include "vantage/geometry.h"

namespace example {

vantage::Vec3 middle(const vantage::Mesh& mesh) {
  const vantage::Box box = vantage::bounding_box(mesh);
  return (box.min + box.max) / 2;
}

}  // namespace example
