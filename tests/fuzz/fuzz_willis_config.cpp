// libFuzzer target: any bytes as the text of a configuration file of the published program. Nothing but Error(input),
// with one line of each part, may come out; what is accepted must satisfy what the rest of the program relies on.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string_view>

#include "vantage/error.h"
#include "vantage/spheres.h"

namespace {

using vantage::WillisConfig;
using vantage::WillisMesh;
using vantage::WillisVolume;

void require(bool holds) {
  if (!holds) std::abort();
}

void check_mesh(const WillisMesh& mesh) {
  require(mesh.file.is_absolute() && !mesh.where.empty());
  require(mesh.position.allFinite() && mesh.scale.allFinite() && mesh.scale.minCoeff() > 0);
  require((mesh.rotation * mesh.rotation.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-9);
}

void check_volume(const WillisVolume& volume) {
  require(volume.texels >= 1 && volume.texels <= 8192);
  require(volume.origin.allFinite());
  require(std::abs(volume.front.norm() - 1) < 1e-9 && std::abs(volume.up.norm() - 1) < 1e-9);
  require(std::abs(volume.front.dot(volume.up)) < 1e-9);
  const double height = volume.origin.dot(volume.up);
  require(volume.up_min < height && height < volume.up_max);
  require(volume.radius_max > 0);
  require(volume.output.is_absolute() && !volume.where.empty() && !volume.output_where.empty());
}

void check_accepted(const WillisConfig& config) {
  require(!config.meshes.empty() && !config.volumes.empty());
  for (const WillisMesh& mesh : config.meshes) check_mesh(mesh);
  std::set<std::filesystem::path> outputs;
  for (const WillisVolume& volume : config.volumes) {
    check_volume(volume);
    require(outputs.insert(volume.output).second);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    check_accepted(vantage::parse_willis_config(text, "config.yaml"));
  } catch (const vantage::Error& error) {
    require(error.kind() == vantage::ErrorKind::input);
    require(!error.problem().empty() && !error.where().empty() && !error.fix().empty());
    require(error.problem().find('\n') == std::string::npos);
  }
  return 0;
}
