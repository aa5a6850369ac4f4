#include "tiles/hierarchy.h"

#include <numeric>
#include <optional>
#include <utility>

#include "core/text.h"
#include "tiles/tables.h"

namespace vantage::internal::tiles {
namespace {

// A tile is a part of a city. Each instance takes 28 bytes and each parent 4, where a file may state them with one.
constexpr std::uint64_t kMostInstances = 4'000'000, kMostParents = 16'000'000;
// A text that a million features inherit is copied a million times.
constexpr std::size_t kLongestText = 1000;

const Json& required(const Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end()) throw std::string("\"") + key + "\" is missing";
  return *found;
}

std::uint64_t required_count(const Json& object, const char* key) {
  const Json& value = required(object, key);
  if (!value.is_number_unsigned()) throw std::string("\"") + key + "\" is not a whole number";
  return value.get<std::uint64_t>();
}

std::string counted(std::uint64_t number, const std::string& what) { return std::to_string(number) + " " + what; }

}  // namespace

Hierarchy::Hierarchy(const Json& described, std::string_view binary, const core::ProgressReporter& progress,
                     io::UnreadableProperties& unreadable)
    : binary_(binary) {
  if (!described.is_object()) throw std::string("it is not an object");
  io::UnreadableProperties own;
  read_classes(described);
  read_instances(described);
  check_properties(own);
  read_parents(described);
  resolve(progress);
  unreadable.add(own);
}

void Hierarchy::read_classes(const Json& described) {
  const Json& classes = required(described, "classes");
  if (!classes.is_array()) throw std::string("\"classes\" is not an array");
  for (const Json& one : classes) {
    if (!one.is_object()) throw std::string("a class is not an object");
    Class read;
    const auto name = one.find("name");
    if (name != one.end() && name->is_string()) read.name = name->get<std::string>();
    if (read.name.empty()) read.name = "class " + std::to_string(classes_.size());
    if (read.name.size() > kLongestText) throw "a class's name has more than " + counted(kLongestText, "bytes");
    read.length = required_count(one, "length");
    read.properties = &required(one, "instances");
    if (!read.properties->is_object()) throw std::string("\"instances\" of a class is not an object");
    std::vector<std::string> names;
    for (const auto& [property, values] : read.properties->items()) {
      if (values.is_array() || values.is_object()) names.push_back(property);
    }
    read.known = io::identity_properties(names);
    classes_.push_back(std::move(read));
  }
}

void Hierarchy::check_properties(io::UnreadableProperties& unreadable) {
  for (Class& one : classes_) {
    io::IdentityProperties& known = one.known;
    for (std::string* const property : {&known.id, &known.number, &known.name, &known.address, &known.kind}) {
      check_property(*property, one, unreadable);
    }
  }
}

/// Clears the name of a property that has fewer values than the class has instances, or a text that is too long.
void Hierarchy::check_property(std::string& name, const Class& of_class, io::UnreadableProperties& unreadable) const {
  if (name.empty() || of_class.length == 0) return;
  const Json& values = (*of_class.properties)[name];
  const auto refuse = [&](const std::string& problem) {
    unreadable.add("the property \"" + name + "\" of the class \"" + of_class.name + "\" " + problem);
    name.clear();
  };
  if (values.is_object()) {
    try {
      property_text(values, binary_, of_class.length - 1);
    } catch (const std::string& problem) {
      refuse("cannot be read: " + problem);
    }
    return;
  }
  if (values.size() < of_class.length) {
    return refuse("has " + core::count_text(values.size(), "value for ", "values for ") +
                  core::count_text(of_class.length, "instance", "instances"));
  }
  for (const Json& value : values) {
    if (!value.is_string() || value.get_ref<const std::string&>().size() <= kLongestText) continue;
    return refuse("has a text of more than " + counted(kLongestText, "bytes"));
  }
}

void Hierarchy::read_instances(const Json& described) {
  const std::uint64_t count = required_count(described, "instancesLength");
  if (count > kMostInstances) throw "it has more than " + counted(kMostInstances, "instances");
  const std::vector<std::uint32_t> class_ids =
      whole_numbers(required(described, "classIds"), "classIds", count, binary_);
  std::vector<std::uint32_t> met(classes_.size(), 0);
  instances_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (class_ids[i] >= classes_.size()) {
      throw "instance " + counted(i, "is of class ") + std::to_string(class_ids[i]) + ", and there are " +
          counted(classes_.size(), "classes (counted from 0)");
    }
    instances_[i].of_class = class_ids[i];
    instances_[i].index = met[class_ids[i]]++;
  }
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    if (met[i] == classes_[i].length) continue;
    throw "the class \"" + classes_[i].name + "\" states " +
        counted(classes_[i].length, "instances, and \"classIds\" has ") + std::to_string(met[i]);
  }
}

void Hierarchy::read_parents(const Json& described) {
  const auto ids = described.find("parentIds"), counts = described.find("parentCounts");
  if (ids == described.end()) return;
  std::vector<std::uint32_t> count_of(instances_.size(), 1);
  if (counts != described.end()) count_of = whole_numbers(*counts, "parentCounts", instances_.size(), binary_);
  const std::uint64_t total = std::accumulate(count_of.begin(), count_of.end(), std::uint64_t{0});
  if (total > kMostParents) throw "its instances have more than " + counted(kMostParents, "parents");
  parents_ = whole_numbers(*ids, "parentIds", total, binary_);
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < instances_.size(); ++i) {
    instances_[i].first_parent = next;
    next += count_of[i];
    for (std::uint32_t k = instances_[i].first_parent; k < next; ++k) {
      if (parents_[k] < instances_.size()) continue;
      throw "a parent of instance " + counted(i, "is instance ") + std::to_string(parents_[k]) + ", and there are " +
          counted(instances_.size(), "(counted from 0)");
    }
  }
}

std::uint32_t Hierarchy::end_of_parents(std::uint32_t instance) const {
  return instance + 1 < instances_.size() ? instances_[instance + 1].first_parent
                                          : static_cast<std::uint32_t>(parents_.size());
}

/// Parents before their children, without recursion: a chain may be as long as there are instances.
void Hierarchy::resolve(const core::ProgressReporter& progress) {
  enum class State : std::uint8_t { fresh, open, done };
  struct Visit {
    std::uint32_t instance, next_parent;
  };
  std::vector<State> state(instances_.size(), State::fresh);
  std::vector<Visit> open;
  const auto enter = [&](std::uint32_t instance) {
    state[instance] = State::open;
    open.push_back({instance, instances_[instance].first_parent});
  };
  for (std::uint32_t first = 0; first < instances_.size(); ++first) {
    if (first % 65536 == 0) progress.check();
    if (state[first] == State::fresh) enter(first);
    while (!open.empty()) {
      Visit& here = open.back();
      if (here.next_parent == end_of_parents(here.instance)) {
        settle(here.instance);
        state[here.instance] = State::done;
        open.pop_back();
        continue;
      }
      const std::uint32_t parent = parents_[here.next_parent++];
      if (parent == here.instance) continue;  // so the extension says that there is none
      if (state[parent] == State::open) throw "instance " + counted(parent, "is its own ancestor");
      if (state[parent] == State::fresh) enter(parent);
    }
  }
}

/// Whose properties an instance has, once its parents know.
void Hierarchy::settle(std::uint32_t number) {
  Instance& instance = instances_[number];
  const Class& own = classes_[instance.of_class];
  const auto has = [&](const std::string& property) { return !text(instance, property).empty(); };
  if (has(own.known.id)) instance.id = instance.number = number;
  if (instance.number == kNone && has(own.known.number)) instance.number = number;
  if (has(own.known.name) || has(own.known.address)) instance.label = number;
  instance.kind = io::kind_of_feature(text(instance, own.known.kind));
  if (instance.kind == ObjectKind::other) instance.kind = io::kind_of_feature(own.name);
  for (std::uint32_t k = instance.first_parent; k < end_of_parents(number); ++k) {
    if (parents_[k] != number) inherit(instance, instances_[parents_[k]]);
  }
}

void Hierarchy::inherit(Instance& instance, const Instance& parent) {
  // What stands on the ground is not ground, nor one object with it.
  if (parent.kind == ObjectKind::ground && instance.kind != ObjectKind::ground) return;
  if (instance.number == kNone) instance.number = instance.label == kNone ? parent.number : parent.id;
  if (instance.id == kNone) instance.id = parent.id;
  if (instance.label == kNone) instance.label = parent.label;
  if (instance.kind == ObjectKind::other) instance.kind = parent.kind;
}

std::string Hierarchy::text(const Instance& instance, const std::string& property) const {
  if (property.empty()) return {};
  return property_text((*classes_[instance.of_class].properties)[property], binary_, instance.index);
}

std::size_t Hierarchy::Known::bytes() const {
  return values.id.size() + values.number.size() + values.name.size() + values.address.size();
}

Hierarchy::Known Hierarchy::known(std::uint64_t feature) const {
  const Instance& asked = instances_[feature];
  Known result;
  result.instance = asked.label == kNone ? feature : asked.label;
  result.kind = asked.kind;
  if (asked.label != kNone) {
    const Instance& labelled = instances_[asked.label];
    result.values.name = text(labelled, classes_[labelled.of_class].known.name);
    result.values.address = text(labelled, classes_[labelled.of_class].known.address);
  }
  if (asked.number != kNone) {
    const Instance& numbered = instances_[asked.number];
    const Class& its = classes_[numbered.of_class];
    result.values.id = text(numbered, its.known.id);
    // Classes count each for itself.
    if (result.values.id.empty()) result.values.number = its.name + "/" + text(numbered, its.known.number);
  }
  return result;
}

}  // namespace vantage::internal::tiles
