#include "io/write_sidecar.h"

#include "io/georeference_text.h"
#include "io/writers.h"

namespace vantage::internal::io {

std::string place_comment(const std::optional<Georeference>& georeference, const char* start) {
  if (!georeference) return {};
  std::string line(start);
  line.append(io::kGeoreferenceMark).append(" ").append(io::georeference_text(*georeference));
  return line.append("\n");
}

std::unique_ptr<AtomicFile> stage_sidecar(const io::Sidecar& content, const std::filesystem::path& mesh_file) {
  if (output_extension(mesh_file) != ".stl") return nullptr;
  const std::filesystem::path file = io::sidecar_file(mesh_file);
  std::error_code ignored;
  if (!content.georeference && !content.rounding_m && !std::filesystem::exists(file, ignored)) return nullptr;
  auto output = std::make_unique<AtomicFile>(file);
  output->write(io::sidecar_text(content));
  return output;
}

}  // namespace vantage::internal::io
