// An XML text as a tree of elements. Expat reads it; names of spaces are left off ("gx:Track" is "Track").
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "flight/plans/plan_source.h"

namespace vantage::internal::flight::plans {

class XmlTree {
 public:
  using Node = std::uint32_t;
  static constexpr Node kNone = 0xFFFFFFFF;

  /// At most kMostElements elements and attributes, nested at most 100 deep; about 32 bytes for each. Throws
  /// Error(plan_syntax) with the line for broken XML and for a DOCTYPE, which could name entities that grow without
  /// end; Error(file_too_large).
  explicit XmlTree(const PlanSource& source);

  static constexpr std::size_t kMostElements = 3'000'000;

  Node root() const { return 0; }
  std::string_view name(Node node) const { return names_[nodes_[node].name]; }
  /// What stands in it, without that of its children, without blanks at its ends.
  std::string_view text(Node node) const;
  std::uint64_t line(Node node) const { return nodes_[node].line; }

  Node first_child(Node node) const { return nodes_[node].first_child; }
  Node next(Node node) const { return nodes_[node].next; }
  /// The first child of that name, or kNone. Attributes are children too: "@lat".
  Node child(Node node, std::string_view name) const;
  /// The text of it, empty where there is none.
  std::string_view child_text(Node node, std::string_view name) const;

  /// Calls `visit(node)` for each descendant, in the order of the text. `visit` returns whether to go into it.
  template <typename Visit>
  void walk(Node from, const Visit& visit) const {
    for (Node node = first_child(from); node != kNone; node = next(node)) {
      if (visit(node)) walk(node, visit);  // as deep as elements are: at most 100
    }
  }

 private:
  friend class XmlBuilder;
  struct Element {
    std::uint32_t name = 0, line = 0, text_begin = 0, text_end = 0;
    Node first_child = kNone, last_child = kNone, next = kNone;
  };

  std::vector<Element> nodes_;
  std::vector<std::string> names_;
  std::string texts_;
};

}  // namespace vantage::internal::flight::plans
