// Views as JSON objects.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "vantage/standpoints.h"

namespace vantage::internal::flight {

using Json = nlohmann::ordered_json;

/// Adds the members of a view to `row`. What is not known is null.
void add_view(Json& row, const ViewDescription& view);

/// The text of JSON whose texts may not be UTF-8, indented, a newline at the end.
std::string dumped(const Json& json);

}  // namespace vantage::internal::flight
