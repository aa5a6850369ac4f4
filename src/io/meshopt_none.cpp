// Where vantage is built without meshoptimizer.
#include "io/mesh_codecs.h"

namespace vantage::internal::io {

std::string decode_meshopt(std::string_view /*data*/, const MeshoptView& /*view*/, const core::ReadLimits& /*limits*/) {
  throw CodecProblem{"it is compressed with meshoptimizer, and vantage was built without that library", true};
}

}  // namespace vantage::internal::io
