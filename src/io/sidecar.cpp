#include "io/sidecar.h"

#include <nlohmann/json.hpp>

#include "common/output.h"
#include "io/georeference_text.h"
#include "io/json_text.h"
#include "io/object_text.h"
#include "io/rounding_text.h"
#include "vantage/error.h"

namespace vantage::internal::io {

std::filesystem::path sidecar_file(const std::filesystem::path& mesh_file) {
  std::filesystem::path name = mesh_file;
  if (name.extension() == ".gz") name.replace_extension();  // compressed, it is the same mesh
  return name += ".place.json";
}

std::string sidecar_text(const Sidecar& content) {
  nlohmann::ordered_json json;
  json["vantage"]["georeference"] = nullptr;
  if (content.georeference) json["vantage"]["georeference"] = georeference_json(*content.georeference);
  if (content.rounding_m) json["vantage"]["rounding_m"] = *content.rounding_m;
  for (const std::string& entry : content.ledger_texts) {
    json["vantage"]["ledger"].push_back(nlohmann::ordered_json::parse(entry));
  }
  if (!content.volume.empty()) json["vantage"]["volume"] = nlohmann::ordered_json::parse(content.volume);
  return json.dump(2, ' ', true, nlohmann::json::error_handler_t::replace) + "\n";
}

Sidecar read_sidecar(const MeshSource& mesh, const core::ProgressReporter& progress) {
  const std::filesystem::path file = sidecar_file(mesh.file());
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return {};
  try {
    const nlohmann::json json = parse_json(read_file_bytes(file, progress), progress, {});
    const auto place = georeference_in(json);
    if (!place) throw GeoreferenceProblem{"the file holds no georeference of vantage"};
    Sidecar content;
    if (!place->is_null()) content.georeference = parse_georeference(*place);
    content.rounding_m = rounding_in(json);
    content.ledger = ledger_in(json);
    return content;
  } catch (const JsonProblem& problem) {
    throw Error(ErrorCode::record_garbled, problem.text, file.string(), "correct or remove the file");
  } catch (const LedgerProblem& problem) {
    throw Error(ErrorCode::record_garbled, problem.text, file.string(), "correct or remove the file");
  } catch (const RoundingProblem& problem) {
    throw Error(ErrorCode::record_garbled, problem.text, file.string(), "correct or remove the file");
  } catch (const GeoreferenceProblem& problem) {
    throw Error(ErrorCode::record_garbled, problem.text, file.string(),
                "correct or remove the file; the mesh is read without");
  }
}

void stage_sidecar(const Sidecar& content, const std::filesystem::path& mesh_file,
                   std::vector<std::unique_ptr<AtomicFile>>& files) {
  const std::filesystem::path file = sidecar_file(mesh_file);
  std::error_code ignored;
  const bool is_empty = !content.georeference && !content.rounding_m && content.ledger_texts.empty();
  if (is_empty && !std::filesystem::exists(file, ignored)) return;
  check_derived_output(file);
  files.push_back(std::make_unique<AtomicFile>(file));
  files.back()->write(sidecar_text(content));
}

}  // namespace vantage::internal::io
