// The cameras that vantage knows.
#include <nanobind/stl/string.h>

#include <string>
#include <vector>

#include "bindings.h"
#include "common/json.h"
#include "vantage/camera.h"

namespace vantage::python {

namespace {

std::string cameras() {
  std::vector<ListedCamera> listed;
  for (const Camera& camera : known_cameras()) listed.push_back({camera, ""});
  return json_text(listed);
}

}  // namespace

void bind_cameras(nb::module_& module) { module.def("cameras", &cameras); }

}  // namespace vantage::python
