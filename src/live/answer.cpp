#include "live/answer.h"

#include <new>
#include <nlohmann/json.hpp>

#include "vantage/error.h"

namespace vantage::live {
namespace {

using Json = nlohmann::ordered_json;

Json error_object(const std::string& code, const std::string& problem, const std::string& where,
                  const std::string& fix) {
  return Json{{"error", {{"code", code}, {"problem", problem}, {"where", where}, {"fix", fix}}}};
}

}  // namespace

Json error_json(const std::exception& error) {
  if (const auto* own = dynamic_cast<const Error*>(&error)) {
    return error_object(name_of(own->code()), own->problem(), own->where(), own->fix());
  }
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    return error_object(name_of(ErrorCode::out_of_memory), "there is not enough memory for this", "",
                        "use a smaller scene or range");
  }
  return error_object(name_of(ErrorCode::internal_defect), error.what(), "", "please report this");
}

std::string answered(const std::function<std::string()>& work) {
  try {
    return work();
  } catch (const std::exception& error) {
    return error_json(error).dump(-1, ' ', false, Json::error_handler_t::replace);
  }
}

}  // namespace vantage::live
