#include "app/spheres_section.h"

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "app/places.h"
#include "app/schema.h"
#include "options/spheres_options.h"
#include "vantage/input.h"

namespace vantage::internal::app {
namespace {

int whole_number(const YamlNode& node, const ValueReader& reader, const std::string& what) {
  const double value = reader.number(node, what);
  if (value != std::floor(value) || std::abs(value) > std::numeric_limits<int>::max()) {
    reader.fail(ErrorCode::wrong_type, node, what + " must be a whole number, not " + shortest(value),
                "write it without a fraction");
  }
  return static_cast<int>(value);
}

template <typename Value>
Value one_of(const YamlNode& node, const ValueReader& reader, const std::string& what,
             const std::array<std::pair<const char*, Value>, 2>& values) {
  const std::string text = reader.text(node, what);
  for (const auto& [name, value] : values) {
    if (text == name) return value;
  }
  const std::string names = std::string(values[0].first) + " or " + values[1].first;
  reader.fail(ErrorCode::unknown_choice, node, what + " must be " + names + ", not " + in_quotes(text),
              "write " + names);
}

}  // namespace

void parse_spheres(const YamlNode& node, const ValueReader& reader, SpheresOptions& options) {
  using Sphere = SpheresOptions::Sphere;
  using Split = SpheresOptions::Split;
  check_keys(node, Section::spheres, reader.file());
  const YamlNode* last = &node;  // what is out of range is told of the key that brought it
  const auto check = [&] {
    with_place(place_in(reader.file(), last->place), [&] {
      options::check_options(options);
      return 0;
    });
  };
  const auto take = [&](const char* key, const auto& set) {
    last = find(node, key);
    if (last == nullptr) return;
    set(*last, std::string("spheres.") + key);
    check();
  };
  take("sphere", [&](const YamlNode& value, const std::string& what) {
    options.sphere =
        one_of<Sphere>(value, reader, what, {{{"conservative", Sphere::conservative}, {"centers", Sphere::centers}}});
  });
  take("cubemap",
       [&](const YamlNode& value, const std::string& what) { options.cubemap = whole_number(value, reader, what); });
  take("resolution", [&](const YamlNode& value, const std::string& what) {
    const char* const form = "write the samples in longitude and latitude: [160, 80]";
    if (reader.list(value, what, form).size() != 2) {
      reader.fail(ErrorCode::wrong_type, value, what + " must be two whole numbers, not " + describe(value), form);
    }
    options.resolution = {whole_number(value.items[0], reader, what + "[0]"),
                          whole_number(value.items[1], reader, what + "[1]")};
  });
  take("merge", [&](const YamlNode& value, const std::string& what) { options.merge = reader.number(value, what); });
  take("split", [&](const YamlNode& value, const std::string& what) {
    options.split = one_of<Split>(value, reader, what, {{{"euler", Split::euler}, {"always", Split::always}}});
  });
  take("max_splits",
       [&](const YamlNode& value, const std::string& what) { options.max_splits = whole_number(value, reader, what); });
  take("min_edge", [&](const YamlNode& value, const std::string& what) {
    options.min_edge_m = reader.positive_length(value, what);
  });
  take("device", [&](const YamlNode& value, const std::string& what) {
    const std::string text = reader.text(value, what);
    options.device = with_place(place_in(reader.file(), value.place), [&] { return parse_device_choice(text); });
  });
}

}  // namespace vantage::internal::app
