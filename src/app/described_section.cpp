#include "app/described_section.h"

#include <array>
#include <cmath>
#include <limits>

#include "app/schema.h"
#include "common/input.h"
#include "core/places.h"
#include "vantage/error.h"

namespace vantage::internal::app {
namespace {

std::string list_text(std::initializer_list<double> numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : ", ") + shortest(number);
  return "[" + text + "]";
}

/// Null where there is none. `path`: "view.dwell".
const YamlNode* node_at(const YamlNode& map, std::string_view path) {
  const YamlNode* node = &map;
  while (node != nullptr) {
    const std::size_t dot = path.find('.');
    node = find(*node, path.substr(0, dot));
    if (dot == std::string_view::npos) break;
    path.remove_prefix(dot + 1);
  }
  return node;
}

std::string text_of(const DeviceChoice& device) {
  switch (device.kind) {
    case DeviceChoice::Kind::automatic:
      return "auto";
    case DeviceChoice::Kind::cpu:
      return "cpu";
    case DeviceChoice::Kind::opengl:
      return "opengl";
    case DeviceChoice::Kind::gpu:
      return "gpu";
    case DeviceChoice::Kind::index:
      return "\"" + std::to_string(device.index) + "\"";  // what is read is a text
  }
  return "auto";
}

}  // namespace

void check_maps(const YamlNode& section, const std::vector<request::KeyList>& lists, const ValueReader& reader) {
  const std::string& name = lists.front().name;
  for (const request::KeyList& list : lists) {
    const bool is_whole = &list == &lists.front();
    const YamlNode* const map =
        is_whole ? &section : node_at(section, std::string_view{list.name}.substr(name.size() + 1));
    if (map) check_keys(*map, list, reader.file());
  }
}

const YamlNode* SectionReader::required(const request::Key& key) const {
  const YamlNode* const node = node_at(root_, key.path);
  if (node != nullptr || !key.is_required) return node;
  const std::size_t dot = key.path.rfind('.');
  const YamlNode* const map = dot == std::string_view::npos ? &root_ : node_at(root_, key.path.substr(0, dot));
  if (map == nullptr) return nullptr;
  const std::string map_name = section_ + (dot == std::string_view::npos ? "" : "." + std::string(key.path, 0, dot));
  const std::string word(key.path.substr(dot == std::string_view::npos ? 0 : dot + 1));
  reader_.fail(ErrorCode::missing_key, *map, map_name + " lacks the key '" + word + "'", std::string(key.form));
}

const YamlNode* SectionReader::node_for(const request::Key& key, const request::Only& only) const {
  const YamlNode* const node = required(key);
  if (node != nullptr && !only.holds) {
    reader_.fail(ErrorCode::not_applicable, *node, name_of(key) + " is not of a " + std::string(only.otherwise),
                 "leave it out");
  }
  return node;
}

double SectionReader::value_of(const YamlNode& node, const std::string& name, const request::Bounds& bounds) const {
  switch (bounds.unit) {
    case request::Unit::metres:
      return reader_.length(node, name);
    case request::Unit::degrees:
      return reader_.angle(node, name);
    default:
      return reader_.number(node, name);
  }
}

void SectionReader::number(const request::Key& key, double& value, const request::Bounds& bounds,
                           const request::Only& only) const {
  const YamlNode* const node = node_for(key, only);
  if (node == nullptr) return;
  value = value_of(*node, name_of(key), bounds);
  core::with_place(place_in(reader_.file(), node->place), [&] {
    check_within(bounds, value, name_of(key));
    return 0;
  });
}

void SectionReader::number(const request::Key& key, std::optional<double>& value, const request::Bounds& bounds,
                           const request::Only& only) const {
  if (node_at(root_, key.path) != nullptr) number(key, value.emplace(), bounds, only);
}

void SectionReader::pair(const request::Key& key, double& low, const request::Bounds& of_low, double& high,
                         const request::Bounds& of_high, const request::Only& only) const {
  const YamlNode* const node = node_for(key, only);
  if (node == nullptr) return;
  const std::string name = name_of(key);
  if (reader_.list(*node, name, std::string(key.form)).size() != 2) {
    reader_.fail(ErrorCode::wrong_type, *node, name + " must be two numbers, not " + describe(*node),
                 std::string(key.form));
  }
  low = value_of(node->items[0], name + "[0]", of_low);
  high = value_of(node->items[1], name + "[1]", of_high);
  core::with_place(place_in(reader_.file(), node->place), [&] {
    check_within(of_low, low, name + "[0]");
    check_within(of_high, high, name + "[1]");
    return 0;
  });
}

int SectionReader::whole_of(const YamlNode& node, const std::string& name) const {
  const double value = reader_.number(node, name);
  if (value != std::floor(value) || std::abs(value) > std::numeric_limits<int>::max()) {
    reader_.fail(ErrorCode::wrong_type, node, name + " must be a whole number, not " + shortest(value),
                 "write it without a fraction");
  }
  return static_cast<int>(value);
}

void SectionReader::whole(const request::Key& key, int& value, const request::Bounds& bounds) const {
  const YamlNode* const node = required(key);
  if (node == nullptr) return;
  value = whole_of(*node, name_of(key));
  core::with_place(place_in(reader_.file(), node->place), [&] {
    check_within(bounds, value, name_of(key));
    return 0;
  });
}

void SectionReader::grid(const request::Key& key, std::optional<std::array<int, 2>>& value,
                         const request::Bounds& of_first, const request::Bounds& of_second) const {
  const YamlNode* const node = required(key);
  if (node == nullptr) return;
  const std::string name = name_of(key), form(key.form);
  if (reader_.list(*node, name, form).size() != 2) {
    reader_.fail(ErrorCode::wrong_type, *node, name + " must be two whole numbers, not " + describe(*node), form);
  }
  value = {whole_of(node->items[0], name + "[0]"), whole_of(node->items[1], name + "[1]")};
  core::with_place(place_in(reader_.file(), node->place), [&] {
    check_within(of_first, (*value)[0], name + "[0]");
    check_within(of_second, (*value)[1], name + "[1]");
    return 0;
  });
}

void SectionReader::device(const request::Key& key, DeviceChoice& value) const {
  const YamlNode* const node = required(key);
  if (node == nullptr) return;
  const std::string text = reader_.text(*node, name_of(key));
  value = core::with_place(place_in(reader_.file(), node->place), [&] { return parse_device_choice(text); });
}

void SectionReader::flag(const request::Key& key, bool& value) const {
  const YamlNode* const node = required(key);
  if (node == nullptr) return;
  value = reader_.flag(*node, name_of(key));
}

void SectionReader::home(const request::Key& key, std::optional<TourHome>& value) const {
  const YamlNode* const node = required(key);
  if (node == nullptr) return;
  const std::string name = name_of(key), form(key.form);
  if (reader_.list(*node, name, form).size() == 2) {
    const double latitude = reader_.angle(node->items[0], name + "[0]");
    value = TourHome{std::array{latitude, reader_.angle(node->items[1], name + "[1]")}, {}};
  } else {
    value = TourHome{{}, reader_.vector(*node, name, form.c_str())};
  }
}

void SectionReader::fail_choice(const request::Key& key, const YamlNode& node, const std::string& word,
                                const std::vector<std::string_view>& words) const {
  std::string known;
  for (const std::string_view one : words) {
    known += (known.empty() ? "" : one == words.back() ? " or " : ", ") + std::string(one);
  }
  reader_.fail(ErrorCode::unknown_choice, node, name_of(key) + " must be " + known + ", not " + in_quotes(word),
               std::string(key.form));
}

void SectionWriter::number(const request::Key& key, double value, const request::Bounds& /*bounds*/,
                           const request::Only& only) {
  const bool is_none = (key.is_none_at_zero && value == 0) || (key.is_none_at_infinity && std::isinf(value));
  if (only.holds && !is_none) add(key.path, shortest(value));
}

void SectionWriter::pair(const request::Key& key, double low, const request::Bounds& /*of_low*/, double high,
                         const request::Bounds& /*of_high*/, const request::Only& only) {
  if (only.holds) add(key.path, list_text({low, high}));
}

void SectionWriter::home(const request::Key& key, const std::optional<TourHome>& value) {
  if (!value) return;
  if (const auto& at_deg = value->at_deg) {
    add(key.path, list_text({(*at_deg)[0], (*at_deg)[1]}));
  } else if (value->position) {
    add(key.path, list_text({value->position->x(), value->position->y(), value->position->z()}));
  }
}

void SectionWriter::grid(const request::Key& key, const std::optional<std::array<int, 2>>& value,
                         const request::Bounds& /*of_first*/, const request::Bounds& /*of_second*/) {
  if (value) add(key.path, list_text({static_cast<double>((*value)[0]), static_cast<double>((*value)[1])}));
}

void SectionWriter::device(const request::Key& key, const DeviceChoice& value) { add(key.path, text_of(value)); }

std::string SectionWriter::text(std::string_view section) const {
  std::string text = std::string(section) + ":\n", open;
  for (const auto& [path, value] : entries_) {
    const std::size_t dot = path.find('.');
    const std::string map(dot == std::string_view::npos ? "" : path.substr(0, dot));
    const std::string key(dot == std::string_view::npos ? path : path.substr(dot + 1));
    if (!open.empty() && open != map) text += "}\n";
    if (map.empty()) {
      text.append("  ").append(key).append(": ").append(value).append("\n");
    } else {
      text.append(open == map ? ", " : "  " + map + ": {").append(key).append(": ").append(value);
    }
    open = map;
  }
  return open.empty() ? text : text + "}\n";
}

std::string SectionWriter::flow() const {
  std::string text;
  for (const auto& [path, value] : entries_) {
    text.append(text.empty() ? "" : ", ").append(path).append(": ").append(value);
  }
  return "{" + text + "}";
}

}  // namespace vantage::internal::app
