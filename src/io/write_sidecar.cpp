#include "io/write_sidecar.h"

#include "io/georeference_text.h"

namespace vantage::internal::io {

std::string place_comment(const std::optional<Georeference>& georeference, const char* start) {
  if (!georeference) return {};
  std::string line(start);
  line.append(io::kGeoreferenceMark).append(" ").append(io::georeference_text(*georeference));
  return line.append("\n");
}

void stage_sidecar(const Sidecar& content, const std::filesystem::path& mesh_file,
                   std::vector<std::unique_ptr<AtomicFile>>& files) {
  const std::filesystem::path file = sidecar_file(mesh_file);
  std::error_code ignored;
  if (!content.georeference && !content.rounding_m && !std::filesystem::exists(file, ignored)) return;
  files.push_back(std::make_unique<AtomicFile>(file));
  files.back()->write(sidecar_text(content));
}

}  // namespace vantage::internal::io
