// How an object's identity is written into scene files, and read again. See docs/scene.md.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "vantage/scene.h"

namespace vantage::internal::io {

/// Whether the name that a file format has does not tell all.
bool says_more_than_name(const SceneObject& object);

/// {"name": …, "source_id": …, "kind": …} on one line; what is empty is left out.
std::string object_text(const SceneObject& object);

/// The comment of an OBJ file that holds it: "vantage object: {…}".
std::string object_comment(const SceneObject& object);

/// Reads what object_text has written. Nothing for what is garbled.
std::optional<SceneObject> parse_object(const nlohmann::json& written);

/// Reads the value of "object" in the object "vantage" of `extras`. Nothing where it is missing or garbled: the name in
/// the file then counts.
std::optional<SceneObject> object_in(const nlohmann::json& extras);

/// Likewise of the text of a comment, after its sign of a comment.
std::optional<SceneObject> object_in_comment(std::string_view comment);

/// An object of which a file says the name only. "ground" and "surface", the names that vantage gives to the ground of
/// maps and to rasters, are of these kinds: so other programs may pass such scenes on.
SceneObject object_named(std::string name);

}  // namespace vantage::internal::io
