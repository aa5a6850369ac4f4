#include "io/object_text.h"

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

namespace vantage::internal::io {
namespace {

using ObjectJson = nlohmann::json;

constexpr std::string_view kObjectMark = "vantage object:";

constexpr std::array kObjectKinds = {
    ObjectKind::other, ObjectKind::ground, ObjectKind::surface, ObjectKind::building, ObjectKind::building_part,
    ObjectKind::wall,  ObjectKind::tower,  ObjectKind::bridge,  ObjectKind::tree,     ObjectKind::stand_in};

std::optional<ObjectKind> object_kind_named(std::string_view name) {
  for (const ObjectKind kind : kObjectKinds) {
    if (name == name_of(kind)) return kind;
  }
  return std::nullopt;
}

}  // namespace

std::optional<SceneObject> parse_object(const ObjectJson& written) {
  if (!written.is_object()) return std::nullopt;
  SceneObject object;
  for (const auto& [key, value] : written.items()) {
    if (!value.is_string()) return std::nullopt;
    const auto& text = value.get_ref<const std::string&>();
    if (key == "name") object.name = text;
    if (key == "source_id") object.source_id = text;
    if (key == "kind") {
      const auto kind = object_kind_named(text);
      if (!kind) return std::nullopt;
      object.kind = *kind;
    }
  }
  return object;
}

bool says_more_than_name(const SceneObject& object) { return !(object == object_named(display_name(object))); }

std::string object_text(const SceneObject& object) {
  std::string text = "{";
  const auto add = [&](const char* key, std::string_view value) {
    text.append(text.size() > 1 ? ",\"" : "\"").append(key).append("\":");
    text.append(ObjectJson(value).dump(-1, ' ', true, ObjectJson::error_handler_t::replace));
  };
  if (!object.name.empty()) add("name", object.name);
  if (!object.source_id.empty()) add("source_id", object.source_id);
  if (object.kind != ObjectKind::other) add("kind", name_of(object.kind));
  return text + "}";
}

std::string object_comment(const SceneObject& object) {
  return std::string(kObjectMark).append(" ").append(object_text(object));
}

std::optional<SceneObject> object_in(const ObjectJson& extras) {
  if (!extras.is_object()) return std::nullopt;
  const auto ours = extras.find("vantage");
  if (ours == extras.end() || !ours->is_object()) return std::nullopt;
  const auto object = ours->find("object");
  return object == ours->end() ? std::nullopt : parse_object(*object);
}

std::optional<SceneObject> object_in_comment(std::string_view comment) {
  const std::size_t first = comment.find_first_not_of(' ');
  if (first == std::string_view::npos || !comment.substr(first).starts_with(kObjectMark)) return std::nullopt;
  const ObjectJson json = ObjectJson::parse(comment.substr(first + kObjectMark.size()), nullptr, false);
  return json.is_discarded() ? std::nullopt : parse_object(json);
}

SceneObject object_named(std::string name) {
  SceneObject object{std::move(name), "", ObjectKind::other};
  if (object.name == "ground") object.kind = ObjectKind::ground;
  if (object.name == "surface") object.kind = ObjectKind::surface;
  return object;
}

}  // namespace vantage::internal::io
