// Where vantage is built without Draco.
#include "io/mesh_codecs.h"

namespace vantage::internal::io {

DracoMesh decode_draco(std::string_view /*data*/, const std::vector<std::uint32_t>& /*attributes*/,
                       std::uint64_t /*most_triangles*/, const core::ReadLimits& /*limits*/) {
  throw CodecProblem{"it is compressed with Draco, and vantage was built without that library", true};
}

}  // namespace vantage::internal::io
