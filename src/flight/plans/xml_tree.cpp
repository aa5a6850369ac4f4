#include "flight/plans/xml_tree.h"

#include <expat.h>

#include <exception>
#include <memory>
#include <unordered_map>
#include <utility>

namespace vantage::internal::flight::plans {

class XmlBuilder {
 public:
  XmlBuilder(const PlanSource& source, XmlTree& tree)
      : source_(source), tree_(tree), parser_(XML_ParserCreate(source.was_utf16 ? "UTF-8" : nullptr)) {
    if (!parser_) throw std::bad_alloc();
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), on_start, on_end);
    XML_SetCharacterDataHandler(parser_.get(), on_text);
    XML_SetStartDoctypeDeclHandler(parser_.get(), on_doctype);
  }

  void build() {
    const std::string_view text = source_.text;
    const XML_Status status = XML_Parse(parser_.get(), text.data(), static_cast<int>(text.size()), XML_TRUE);
    if (error_) std::rethrow_exception(error_);
    if (status != XML_STATUS_OK) {
      fail(std::string("the XML is broken: ") + XML_ErrorString(XML_GetErrorCode(parser_.get())), "save the file anew");
    }
  }

 private:
  struct FreeParser {
    void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
  };
  struct Open {
    XmlTree::Node node;
    std::string text;
  };

  // Errors may not pass through Expat, which is C: they wait until it is left.
  template <typename Action>
  static void guarded(void* builder, const Action& action) {
    XmlBuilder& self = *static_cast<XmlBuilder*>(builder);
    if (self.error_) return;
    try {
      action(self);
    } catch (...) {
      self.error_ = std::current_exception();
      XML_StopParser(self.parser_.get(), XML_FALSE);
    }
  }
  static void on_start(void* builder, const char* name, const char** attributes) {
    guarded(builder, [&](XmlBuilder& self) { self.start(name, attributes); });
  }
  static void on_end(void* builder, const char*) {
    guarded(builder, [](XmlBuilder& self) { self.end(); });
  }
  static void on_text(void* builder, const char* text, int length) {
    guarded(builder, [&](XmlBuilder& self) {
      if (!self.open_.empty()) self.open_.back().text.append(text, static_cast<std::size_t>(length));
    });
  }
  static void on_doctype(void* builder, const char*, const char*, const char*, int) {
    guarded(builder, [](XmlBuilder& self) { self.fail("a plan has no DOCTYPE", "take it out"); });
  }

  void start(std::string_view name, const char** attributes) {
    source_.progress.tick();
    if (open_.size() >= kDeepest) fail("elements are nested deeper than 100 levels", "save the file anew");
    const XmlTree::Node node = add(name.substr(name.rfind(':') + 1));
    for (; *attributes; attributes += 2) {
      open_.push_back({node, {}});
      const XmlTree::Node attribute = add("@" + std::string(attributes[0]));
      open_.pop_back();
      keep_text(attribute, attributes[1]);
    }
    open_.push_back({node, {}});
  }

  void end() {
    keep_text(open_.back().node, open_.back().text);
    open_.pop_back();
  }

  void keep_text(XmlTree::Node node, std::string_view text) {
    constexpr std::string_view kBlanks = " \t\r\n";
    const std::size_t begin = text.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return;
    text = text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
    XmlTree::Element& element = tree_.nodes_[node];
    element.text_begin = static_cast<std::uint32_t>(tree_.texts_.size());
    tree_.texts_.append(text);  // no more than the file has bytes, or thrice as many: below 2^32
    element.text_end = static_cast<std::uint32_t>(tree_.texts_.size());
  }

  /// A new child of the innermost element that is open.
  XmlTree::Node add(std::string_view name) {
    if (tree_.nodes_.size() >= XmlTree::kMostElements) {
      fail("the file has more than " + std::to_string(XmlTree::kMostElements) + " elements", "take a part of it",
           ErrorCode::file_too_large);
    }
    const auto node = static_cast<XmlTree::Node>(tree_.nodes_.size());
    XmlTree::Element element;
    element.name = index_of(name);
    element.line = static_cast<std::uint32_t>(XML_GetCurrentLineNumber(parser_.get()));
    tree_.nodes_.push_back(element);
    if (open_.empty()) return node;
    XmlTree::Element& parent = tree_.nodes_[open_.back().node];
    (parent.first_child == XmlTree::kNone ? parent.first_child : tree_.nodes_[parent.last_child].next) = node;
    parent.last_child = node;
    return node;
  }

  std::uint32_t index_of(std::string_view name) {
    const auto [entry, is_new] =
        indices_.try_emplace(std::string(name), static_cast<std::uint32_t>(tree_.names_.size()));
    if (is_new) tree_.names_.emplace_back(name);
    return entry->second;
  }

  [[noreturn]] void fail(const std::string& problem, const std::string& fix,
                         ErrorCode code = ErrorCode::plan_syntax) const {
    source_.fail(code, "line " + std::to_string(XML_GetCurrentLineNumber(parser_.get())), problem, fix);
  }

  static constexpr std::size_t kDeepest = 100;

  const PlanSource& source_;
  XmlTree& tree_;
  std::unique_ptr<XML_ParserStruct, FreeParser> parser_;
  std::exception_ptr error_;
  std::vector<Open> open_;
  std::unordered_map<std::string, std::uint32_t> indices_;
};

XmlTree::XmlTree(const PlanSource& source) { XmlBuilder(source, *this).build(); }

std::string_view XmlTree::text(Node node) const {
  const Element& element = nodes_[node];
  return std::string_view{texts_}.substr(element.text_begin, element.text_end - element.text_begin);
}

XmlTree::Node XmlTree::child(Node node, std::string_view wanted) const {
  for (Node found = first_child(node); found != kNone; found = next(found)) {
    if (name(found) == wanted) return found;
  }
  return kNone;
}

std::string_view XmlTree::child_text(Node node, std::string_view wanted) const {
  const Node found = child(node, wanted);
  return found == kNone ? std::string_view() : text(found);
}

}  // namespace vantage::internal::flight::plans
