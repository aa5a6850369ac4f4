// The format is in vantage/prove.h; tools/check_certificate.py reads it.
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "common/input.h"
#include "vantage/prove.h"

namespace vantage {
namespace {

std::string quoted_json(const std::string& text) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string quoted = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted.append({'\\', c});
    } else if (byte < 0x20) {
      quoted.append("\\u00").append({kDigits[byte >> 4], kDigits[byte & 15]});
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

std::string number_text(double number) { return std::isfinite(number) ? shortest(number) : "null"; }

std::string vector_text(const Vec3& v) {
  std::string text = "[";
  text.append(number_text(v.x())).append(",").append(number_text(v.y())).append(",").append(number_text(v.z()));
  return text.append("]");
}

template <class Item, class Text>
std::string list_text(const std::vector<Item>& items, const Text& text) {
  std::string list = "[";
  for (const Item& item : items) {
    if (list.size() > 1) list += ',';
    list += text(item);
  }
  return list + "]";
}

/// To the base of 36, which is what Python's int() reads as well.
void append_whole(std::string& text, std::int64_t number) {
  constexpr int kBase = 36;
  std::array<char, 16> digits;  // 13 and a sign are enough
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number, kBase);
  text.append(digits.data(), end.ptr);
}

std::string facets_text(const std::vector<std::uint32_t>& facets) {
  std::string text = "\"";
  for (const std::uint32_t facet : facets) {
    if (text.size() > 1) text += ' ';
    append_whole(text, facet);
  }
  return text + '"';
}

/// A character each, but for planes.
std::string steps_text(const std::vector<std::int64_t>& steps) {
  constexpr std::string_view kSigns = "0123456789abcdef(><.";
  std::string text = "\"";
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const char sign = kSigns.at(static_cast<std::size_t>(steps[i]));
    text += sign;
    if (sign != '(') continue;
    for (const char after : {',', ',', ')'}) {
      append_whole(text, steps.at(++i));
      text += after;
    }
  }
  return text + '"';
}

std::string part_text(const CertificatePart& part) {
  return "\n  {\"target\":" + list_text(part.target, vector_text) + ",\n   \"shift_m\":" + number_text(part.shift_m) +
         ",\n   \"centre\":" + vector_text(part.centre) + ",\n   \"corners\":" + list_text(part.corners, vector_text) +
         ",\n   \"normal\":" + vector_text(part.normal) +
         ",\n   \"cut_height_m\":" + (part.all_sides ? "null" : number_text(part.cut_height_m)) +
         ",\n   \"facets\":" + facets_text(part.facets) + ",\n   \"steps\":" + steps_text(part.steps) + "}";
}

std::string box_text(const CertifiedBox& box) {
  return "\n  {\"name\":" + quoted_json(box.name) + ",\"min\":" + vector_text(box.box.min) +
         ",\"max\":" + vector_text(box.box.max) + "}";
}

std::string file_text(const std::string& file, const std::string& hash) {
  return "{\"file\":" + quoted_json(file) + ",\"hash\":" + quoted_json(hash) + "}";
}

}  // namespace

std::string certificate_text(const Certificate& certificate, const CertifiedFiles& files) {
  const std::string& missing = certificate.scene_incomplete;
  return "{\"format\":\"vantage certificate 1\"" +
         (missing.empty() ? "" : ",\n \"scene_incomplete\":" + quoted_json(missing)) +
         ",\n \"scene\":" + file_text(files.scene_file, files.scene_hash) +
         ",\n \"volume\":" + file_text(files.volume_file, files.volume_hash) +
         ",\n \"mission_hash\":" + quoted_json(files.mission_hash) +
         ",\n \"shrink\":" + number_text(certificate.shrink) +
         ",\n \"rounding_m\":" + number_text(certificate.rounding_m) +
         ",\n \"max_range_m\":" + number_text(certificate.max_range_m) +
         ",\n \"boxes\":" + list_text(certificate.boxes, box_text) +
         ",\n \"parts\":" + list_text(certificate.parts, part_text) + "}\n";
}

}  // namespace vantage
