// The format is in docs/proof.md; tools/check_certificate.py reads it.
#include "vantage/certificate.h"

#include <cmath>
#include <span>

#include "vantage/input.h"

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
  return "[" + number_text(v.x()) + "," + number_text(v.y()) + "," + number_text(v.z()) + "]";
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

std::string part_text(const CertificatePart& part) {
  const auto whole = [](auto number) { return std::to_string(number); };
  return "\n  {\"target\":" + list_text(part.target, vector_text) + ",\n   \"shift_m\":" + number_text(part.shift_m) +
         ",\n   \"centre\":" + vector_text(part.centre) + ",\n   \"corners\":" + list_text(part.corners, vector_text) +
         ",\n   \"normal\":" + vector_text(part.normal) +
         ",\n   \"cut_height_m\":" + (part.all_sides ? "null" : number_text(part.cut_height_m)) +
         ",\n   \"facets\":" + list_text(part.facets, whole) + ",\n   \"steps\":" + list_text(part.steps, whole) + "}";
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
  return "{\"format\":\"vantage certificate 1\",\n \"scene\":" + file_text(files.scene_file, files.scene_hash) +
         ",\n \"volume\":" + file_text(files.volume_file, files.volume_hash) +
         ",\n \"mission_hash\":" + quoted_json(files.mission_hash) +
         ",\n \"shrink\":" + number_text(certificate.shrink) +
         ",\n \"rounding_m\":" + number_text(certificate.rounding_m) +
         ",\n \"max_range_m\":" + number_text(certificate.max_range_m) +
         ",\n \"boxes\":" + list_text(certificate.boxes, box_text) +
         ",\n \"parts\":" + list_text(certificate.parts, part_text) + "}\n";
}

}  // namespace vantage
