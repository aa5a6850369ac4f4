#include "common/shown_address.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string>
#include <string_view>

namespace vantage {
namespace {

constexpr std::size_t kNowhere = std::string_view::npos;

bool is_slash(char c) { return c == '/' || c == '\\'; }
char small_letter(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

/// Where a mark is first from `from` on, as it is or escaped: that means the same to some servers.
std::size_t find_mark(std::string_view text, std::string_view marks, std::size_t from = 0) {
  constexpr std::string_view kHex = "0123456789abcdef";
  for (std::size_t i = from; i < text.size(); ++i) {
    if (marks.find(text[i]) != kNowhere) return i;
    if (text[i] != '%' || i + 2 >= text.size()) continue;
    const std::size_t high = kHex.find(small_letter(text[i + 1])), low = kHex.find(small_letter(text[i + 2]));
    if (high != kNowhere && low != kNowhere && marks.find(static_cast<char>(high * 16 + low)) != kNowhere) return i;
  }
  return kNowhere;
}

std::size_t find_last_mark(std::string_view text, std::string_view marks) {
  std::size_t last = kNowhere;
  for (std::size_t at = find_mark(text, marks); at != kNowhere; at = find_mark(text, marks, at + 1)) last = at;
  return last;
}
std::size_t length_of_mark(std::string_view text, std::size_t at) { return text[at] == '%' ? 3 : 1; }

constexpr std::string_view kQueryMarks = "?#;&";

/// Of what follows "https://". Nothing where it is not clear what of it is a password.
std::string without_user(std::string_view rest) {
  constexpr std::string_view kEnds = "/\\?#";
  const std::size_t first = find_mark(rest, "@");
  if (first != kNowhere && rest.find_first_of(kEnds) < first) {
    // Of a query with an "@" and of a password with a "/" or a "?" the parts that may be shown are not the same ones.
    const bool is_path = is_slash(rest[rest.find_first_of(kEnds)]);
    if (!is_path || find_mark(rest, ":") < first) return {};
  } else if (first != kNowhere) {
    const std::size_t path = std::min(rest.find_first_of("/\\", first), rest.size());
    const std::size_t last = find_last_mark(rest.substr(0, path), "@");
    if (rest.find_first_of("?#") < last) return {};
    rest.remove_prefix(last + length_of_mark(rest, last));
  }
  // A name before a colon and no port behind it: a user and a password that are cut off.
  const std::string_view host = rest.substr(0, find_mark(rest, "/\\?#;&"));
  const std::size_t colon = host.find(':', host.starts_with('[') ? std::min(host.find(']'), host.size()) : 0);
  const std::string_view port = colon == kNowhere ? "" : host.substr(colon + 1);
  if (port.find_first_not_of("0123456789") != kNowhere) return {};
  return std::string(rest.substr(0, find_mark(rest, kQueryMarks)));
}

/// Where the next address begins behind its slashes. One without a scheme has a user.
std::size_t find_address(std::string_view text, std::size_t from) {
  for (std::size_t at = from; at + 1 < text.size(); ++at) {
    const bool is_name = at >= 2 && std::isalnum(static_cast<unsigned char>(text[at - 1])) &&
                         std::isalnum(static_cast<unsigned char>(text[at - 2]));  // "C:\" is a disk
    const bool has_scheme = text.substr(at, 3) == "://" || (text[at] == ':' && is_slash(text[at + 1]) && is_name);
    const bool is_begin = at == 0 || !(std::isalnum(static_cast<unsigned char>(text[at - 1])) || text[at - 1] == ':' ||
                                       is_slash(text[at - 1]));
    const bool may_have_user = text.substr(at, 2) == "//" && is_begin;
    if (!has_scheme && !may_have_user) continue;
    const std::size_t rest = std::min(text.find_first_not_of("/\\", at + 1), text.size());
    if (has_scheme) return rest;
    const std::string_view host = text.substr(rest, text.find_first_of("/\\ ", rest) - rest);
    if (find_mark(host, "@") != kNowhere) return rest;
  }
  return kNowhere;
}

bool is_of_scheme(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '+' || c == '.' || c == '-'; }

/// Where the address that begins at `from` ends. Quotes before `done` are of others.
std::size_t end_of_address(std::string_view text, std::size_t done, std::size_t from, bool to_the_end) {
  std::size_t end = text.size();
  // "zip://a.osm::https://..." is two of them.
  for (std::size_t at = text.find("::", from); at != kNowhere && end == text.size(); at = text.find("::", at + 1)) {
    std::size_t scheme = at + 2;
    while (scheme < text.size() && is_of_scheme(text[scheme])) ++scheme;
    if (scheme > at + 2 && scheme + 1 < text.size() && text[scheme] == ':' && is_slash(text[scheme + 1])) end = at;
  }
  if (to_the_end) return end;
  constexpr std::string_view kBegins = " '\"";
  std::size_t begin = from;
  while (begin > done && kBegins.find(text[begin - 1]) == kNowhere) --begin;
  if (begin > done && text[begin - 1] != ' ') end = std::min(end, text.find(text[begin - 1], from));
  for (const std::string_view mark : {", ", ": ", "; "}) end = std::min(end, text.find(mark, from));
  return end;
}

/// Of what may be meant as an address, and is written as none: "me:password@host/a", "https//host/a?key=K",
/// "a.glb;key=K".
std::string without_loose_secrets(std::string_view text, bool to_the_end) {
  std::string shown;
  for (std::size_t done = 0; done < text.size();) {
    const std::size_t word_end = std::min(text.find_first_of(" \t\n'\"", done), text.size());
    const std::string_view word = text.substr(done, word_end - done);
    const std::size_t path = word.find_first_of("./\\:"), value = find_last_mark(word, "=");
    std::size_t end = word_end + 1;
    for (std::size_t begin = 0; begin <= word.size();) {
      const std::string_view part = word.substr(begin, word.find_first_of("/\\", begin) - begin);
      const std::size_t colon = find_mark(part, ":"), mark = find_mark(part, kQueryMarks);
      const std::size_t user = find_last_mark(part, "@");
      const bool has_user = user != kNowhere && colon > 0 && colon < user;
      const bool has_query = mark != kNowhere && path < begin + mark && value != kNowhere && begin + mark < value;
      if (has_user ? mark < user : has_query) {
        shown += part.substr(0, has_user ? 0 : mark);
        end = end_of_address(text, done > 0 ? done - 1 : 0, done + begin, to_the_end);
        break;
      }
      if (has_user) {
        begin += user + length_of_mark(part, user);
        continue;
      }
      shown += part;
      begin += part.size() + 1;
      if (done + begin <= text.size()) shown += text[done + begin - 1];
    }
    done = end;
  }
  return shown;
}

}  // namespace

std::string without_secrets(std::string_view text, bool is_address) {
  std::string shown;
  std::size_t done = 0;
  for (std::size_t at = find_address(text, 0); at != kNowhere; at = find_address(text, done)) {
    const std::size_t end = end_of_address(text, done, at, is_address);
    shown += text.substr(done, at - done);
    shown += without_user(text.substr(at, end - at));
    done = end;
  }
  shown += text.substr(done);
  return without_loose_secrets(shown, is_address);
}

std::filesystem::path shown_address(const std::filesystem::path& file) { return without_secrets(file.string(), true); }

}  // namespace vantage
