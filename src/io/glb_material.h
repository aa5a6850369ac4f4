// What the writers of glTF share of a volume: the colours of its causes, and whom a file of it names.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "vantage/volume.h"

namespace vantage::internal::io {

/// A material of the colours of pictures (src/picture/palette.h), translucent, seen from both sides.
nlohmann::ordered_json cause_material(CauseKind kind);

/// Whom the file has to name. If the volume was read, the georeference alone knows it.
const std::string& credit_of(const Volume& volume);

}  // namespace vantage::internal::io
