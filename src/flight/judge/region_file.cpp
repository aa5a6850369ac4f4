#include "flight/judge/region_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>

#include "common/input.h"
#include "flight/judge/judged_cells.h"
#include "vantage/error.h"

namespace vantage::internal::flight::judge {
namespace {

constexpr std::size_t kVertexBytes = 24, kFaceBytes = 13;
constexpr double kFarthestM = 1e9;
constexpr std::uintmax_t kMostMeshBytes = 4'000'000'000;

[[noreturn]] void fail_mesh(const std::filesystem::path& file, const std::string& problem) {
  throw Error(ErrorCode::record_garbled, problem, file.string(), "take the files that vantage tour wrote together");
}

/// Takes texts from the front of bytes.
class Header {
 public:
  explicit Header(std::string_view bytes) : left_(bytes) {}

  bool take(std::string_view text) {
    if (!left_.starts_with(text)) return false;
    left_.remove_prefix(text.size());
    return true;
  }
  /// 1 to 9999999999, without zeros in front.
  std::optional<std::size_t> take_count() {
    std::size_t digits = 0, value = 0;
    for (; digits < left_.size() && left_[digits] >= '0' && left_[digits] <= '9'; ++digits) {
      if (digits == 10) return std::nullopt;
      value = 10 * value + static_cast<std::size_t>(left_[digits] - '0');
    }
    if (digits == 0 || left_[0] == '0') return std::nullopt;
    left_.remove_prefix(digits);
    return value;
  }
  std::string_view left() const { return left_; }

 private:
  std::string_view left_;
};

template <typename T>
T number_at(std::string_view bytes, std::size_t at) {
  std::array<char, sizeof(T)> raw{};
  std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), sizeof(T), raw.begin());
  if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

}  // namespace

std::string bytes_of(const std::filesystem::path& file, std::uintmax_t most) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (!error && size > most) {
    throw Error(ErrorCode::file_too_large, "the file is larger than any that vantage tour writes", file.string(),
                "name a certificate of vantage tour, or a mesh of it");
  }
  std::ifstream stream(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (!stream.good() && !stream.eof()) {
    throw Error(ErrorCode::file_unreadable, "the file cannot be read", file.string(), "check its permissions");
  }
  return bytes;
}

Mesh read_region_mesh(const std::filesystem::path& file, const std::string& kind) {
  check_readable(file, "a mesh of the certificate");
  const std::string bytes = bytes_of(file, kMostMeshBytes);
  Header header(bytes);
  const bool has_start = header.take("ply\nformat binary_little_endian 1.0\ncomment vantage region: ");
  const bool is_outer = has_start && header.take("outer"), is_given = has_start && !is_outer && header.take("given");
  std::optional<std::size_t> vertices, faces;
  bool is_region = (is_outer || is_given) && header.take("\nelement vertex ");
  if (is_region) vertices = header.take_count();
  is_region = vertices && header.take("\nproperty double x\nproperty double y\nproperty double z\nelement face ");
  if (is_region) faces = header.take_count();
  is_region = faces && header.take("\nproperty list uchar int vertex_indices\nend_header\n");
  if (!is_region) {
    demand(bytes.find("vantage volume: ") == std::string::npos,
           "a mesh is a computed volume, which lies inside the true one: there is no bound of it");
    fail_mesh(file, "the file is no mesh of a region");
  }
  demand(kind == (is_outer ? "outer" : "given"), "a mesh is a region of another kind");
  const std::string_view data = header.left();
  if (data.size() != kVertexBytes * *vertices + kFaceBytes * *faces) {
    fail_mesh(file, "the mesh is not as long as its header says");
  }
  Mesh mesh;
  mesh.vertices.resize(*vertices);
  for (std::size_t v = 0; v < *vertices; ++v) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto x = number_at<double>(data, kVertexBytes * v + 8 * k);
      demand(x >= -kFarthestM && x <= kFarthestM, "a coordinate of a mesh is not finite, or too large");
      mesh.vertices[v][static_cast<Eigen::Index>(k)] = x;
    }
  }
  for (std::size_t f = 0; f < *faces; ++f) {
    const std::size_t at = kVertexBytes * *vertices + kFaceBytes * f;
    Triangle& triangle = mesh.triangles.emplace_back();
    bool is_triangle = data[at] == 3;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto corner = number_at<std::int32_t>(data, at + 1 + 4 * k);
      is_triangle = is_triangle && corner >= 0 && static_cast<std::size_t>(corner) < *vertices;
      triangle[k] = static_cast<std::uint32_t>(corner);
    }
    demand(is_triangle, "a face of a mesh is no triangle of its vertices");
  }
  return mesh;
}

}  // namespace vantage::internal::flight::judge
