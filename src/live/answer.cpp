#include "live/answer.h"

#include <exception>
#include <new>
#include <nlohmann/json.hpp>

#include "vantage/error.h"

namespace vantage::live {
namespace {

std::string error_json(const std::string& code, const std::string& problem, const std::string& where,
                       const std::string& fix) {
  using Json = nlohmann::ordered_json;
  return Json{{"error", {{"code", code}, {"problem", problem}, {"where", where}, {"fix", fix}}}}.dump(
      -1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string answered(const std::function<std::string()>& work) {
  try {
    return work();
  } catch (const Error& error) {
    return error_json(name_of(error.code()), error.problem(), error.where(), error.fix());
  } catch (const std::bad_alloc&) {
    return error_json(name_of(ErrorCode::out_of_memory), "there is not enough memory for this", "",
                      "use a smaller scene or range");
  } catch (const std::exception& error) {
    return error_json(name_of(ErrorCode::internal_defect), error.what(), "", "please report this");
  }
}

}  // namespace vantage::live
