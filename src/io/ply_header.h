// The header of a PLY file: which elements follow, with which properties.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/mesh_file.h"
#include "io/mesh_source.h"
#include "vantage/georeference.h"

namespace vantage::internal::io::ply {

enum class Encoding { ascii, little_endian, big_endian };

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t size_of(Type type);
inline bool is_integer(Type type) { return type != Type::float32 && type != Type::float64; }

struct Property {
  std::string name;
  Type type = Type::float32;  ///< of the value, or of a list's items
  bool is_list = false;
  Type length_type = Type::uint8;  ///< of a list's length
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;

  /// Index of the property with this name, or -1.
  int find(std::string_view property) const;
  /// Fewest bytes that one row of this element takes.
  std::size_t smallest_row(Encoding encoding) const;
};

struct Header {
  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements;
  std::optional<Georeference> georeference;  ///< from a comment of vantage
  std::size_t data = 0;                      ///< byte where the rows begin
  std::uint64_t data_line = 0;               ///< line where they begin
  std::optional<double> rounding_m;          ///< from a comment of vantage
  std::vector<Missing> ledger;               ///< likewise
};

/// Reads and checks a header. Throws Error(input) with the line for whatever it does not understand.
Header read_header(const MeshSource& source);

}  // namespace vantage::internal::io::ply
