#include "io/axes_text.h"

#include <charconv>
#include <cmath>

#include "common/input.h"

namespace vantage::internal::io {
namespace {

constexpr std::string_view kMark = "vantage axes: ", kUpAndUnit = " up, unit ", kMetres = " m";

std::string_view trimmed(std::string_view text) {
  constexpr const char* kBlank = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlank);
  return first == std::string_view::npos ? "" : text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::optional<Axes> parse(std::string_view text) {
  if (text.empty() || (text[0] != 'y' && text[0] != 'z')) return std::nullopt;
  Axes axes;
  axes.up = text[0] == 'y' ? UpAxis::y : UpAxis::z;
  text.remove_prefix(1);
  if (!text.starts_with(kUpAndUnit) || !text.ends_with(kMetres)) return std::nullopt;
  text.remove_prefix(kUpAndUnit.size());
  if (text.size() <= kMetres.size()) return std::nullopt;
  text.remove_suffix(kMetres.size());
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), axes.unit_m);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  return is_number && axes.unit_m > 0 && std::isfinite(axes.unit_m) ? std::optional(axes) : std::nullopt;
}

}  // namespace

std::string axes_text(const Axes& axes) {
  std::string text(kMark);
  text.append(axes.up == UpAxis::y ? "y" : "z").append(kUpAndUnit);
  return text.append(shortest(axes.unit_m)).append(kMetres);
}

void read_axes_comment(std::string_view comment, std::optional<Axes>& known) {
  const std::string_view text = trimmed(comment);
  if (!text.starts_with(trimmed(kMark))) return;
  const std::optional<Axes> axes = text.starts_with(kMark) ? parse(text.substr(kMark.size())) : std::nullopt;
  if (!axes) throw AxesProblem{"the axes that vantage wrote are garbled"};
  if (known && *known != *axes) throw AxesProblem{"the file names two kinds of axes: two meshes were joined"};
  known = axes;
}

}  // namespace vantage::internal::io
