#include "maps/osm/xml_bounds.h"

#include <algorithm>

#include "maps/osm/refused_input.h"

namespace vantage::internal::osm {
namespace {

constexpr std::string_view kComment = "!--", kCharacterData = "![CDATA[";

[[noreturn]] void refuse_length(const std::string& what, std::uint64_t most, std::uint64_t begin) {
  throw RefusedInput(ErrorCode::map_syntax, what + " of the map is longer than " + std::to_string(most >> 20U) + " MiB",
                     "byte " + std::to_string(begin) + " of the XML", "export the map again: no map needs that");
}

}  // namespace

void XmlBounds::check(std::uint64_t position) const {
  const bool is_text = inside_ == Inside::text || inside_ == Inside::character_data;
  if (!is_text && position - tag_begins_ > kMostOfTag) refuse_length("a tag", kMostOfTag, tag_begins_);
  if (depth_ > 1 && position - object_begins_ > kMostOfObject) {
    refuse_length("an object", kMostOfObject, object_begins_);
  }
}

std::size_t XmlBounds::skip_text(std::string_view part, std::size_t at) {
  const std::size_t found = part.find('<', at);
  if (found == std::string_view::npos) return part.size();
  tag_begins_ = passed_ + found;
  if (depth_ <= 1) object_begins_ = tag_begins_;
  inside_ = Inside::opening;
  opening_.clear();
  return found + 1;
}

/// Tells what begins by the bytes after "<": a comment's beginning may lie in two parts.
std::size_t XmlBounds::open(std::string_view part, std::size_t at) {
  opening_ += part[at];
  tail_.clear();
  if (opening_[0] == '?') {
    inside_ = Inside::instruction;
  } else if (opening_ == kComment) {
    inside_ = Inside::comment;
  } else if (opening_ == kCharacterData) {
    inside_ = Inside::character_data;
  } else if (!kComment.starts_with(opening_) && !kCharacterData.starts_with(opening_)) {
    inside_ = Inside::tag;
    quote_ = 0;
    return pass_tag(part, at);  // which may be ">"
  }
  return at + 1;
}

std::size_t XmlBounds::pass_tag(std::string_view part, std::size_t at) {
  char quote = quote_;  // 0 between the values of attributes
  for (; at < part.size(); ++at) {
    const char c = part[at];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '>') {
      check(passed_ + at);
      if (at > 0) tail_ = part[at - 1];
      close_tag();
      return at + 1;
    } else if (c == '"' || c == '\'') {
      quote = c;
    }
  }
  quote_ = quote;
  tail_ = part.back();
  return at;
}

void XmlBounds::close_tag() {
  inside_ = Inside::text;
  if (opening_[0] == '/') {
    if (depth_ > 0) --depth_;
  } else if (opening_[0] != '!' && tail_ != "/") {
    ++depth_;
  }
}

/// Passes a comment and the like, whose end may lie in two parts.
std::size_t XmlBounds::pass_until(std::string_view part, std::size_t at, std::string_view end) {
  for (std::size_t found = part.find('>', at); found != std::string_view::npos; found = part.find('>', found + 1)) {
    const std::size_t from = found - std::min<std::size_t>(found - at, end.size() - 1);
    const std::string last = tail_ + std::string(part.substr(from, found - from + 1));
    if (last.ends_with(end)) {
      check(passed_ + found);
      inside_ = Inside::text;
      return found + 1;
    }
  }
  tail_ += part.substr(at + (part.size() - at) - std::min<std::size_t>(part.size() - at, 2));
  if (tail_.size() > 2) tail_.erase(0, tail_.size() - 2);
  return part.size();
}

void XmlBounds::add(std::string_view part) {
  std::size_t at = 0;
  while (at < part.size()) {
    switch (inside_) {
      case Inside::text:
        at = skip_text(part, at);
        break;
      case Inside::opening:
        at = open(part, at);
        break;
      case Inside::tag:
        at = pass_tag(part, at);
        break;
      case Inside::comment:
        at = pass_until(part, at, "-->");
        break;
      case Inside::character_data:
        at = pass_until(part, at, "]]>");
        break;
      case Inside::instruction:
        at = pass_until(part, at, "?>");
        break;
    }
    check(passed_ + at);
  }
  passed_ += part.size();
}

}  // namespace vantage::internal::osm
