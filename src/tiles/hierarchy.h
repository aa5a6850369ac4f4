// Hierarchies of batch tables (3DTILES_batch_table_hierarchy, an extension of 3D Tiles 1.0): features are instances of
// classes, each with properties of its own, and inherit those of their parents.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/progress_reporter.h"
#include "io/feature_identity.h"
#include "tiles/bounds.h"

namespace vantage::internal::tiles {

class Hierarchy {
 public:
  /// `described`: the extension, `binary`: the batch table's binary part; both must outlive it. Names and ids that
  /// cannot be read are taken as missing, and counted in `unreadable`. Throws std::string for all else that is wrong.
  /// Cost: linear in its instances and their parents.
  Hierarchy(const Json& described, std::string_view binary, const core::ProgressReporter& progress,
            io::UnreadableProperties& unreadable);

  std::uint64_t size() const { return instances_.size(); }  ///< instances

  /// What is known of instance `feature` < size(). Ancestors are asked in this order: the first parent, what that
  /// inherits, the second parent, ...
  struct Known {
    io::IdentityValues values;   ///< empty where neither it nor an ancestor has one; without the kind
    std::uint64_t instance = 0;  ///< that has the name or address: `feature`, or an ancestor of it
    ObjectKind kind = ObjectKind::other;
    std::size_t bytes() const;  ///< of all texts
  };
  Known known(std::uint64_t feature) const;

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  struct Class {
    std::string name;
    std::uint64_t length = 0;
    const Json* properties = nullptr;
    io::IdentityProperties known;
  };
  struct Instance {
    std::uint32_t of_class = 0, index = 0;  ///< among those of its class
    std::uint32_t first_parent = 0;         ///< in parents_; the last one's is before the next instance's first
    // Whose properties it has: its own number, that of an ancestor, or kNone.
    std::uint32_t label = kNone;   ///< name or address
    std::uint32_t id = kNone;      ///< that is unique among all tilesets
    std::uint32_t number = kNone;  ///< id or number, whichever is nearer; a number not from beyond the label
    ObjectKind kind = ObjectKind::other;
  };

  void read_classes(const Json& described);
  void check_properties(io::UnreadableProperties& unreadable);
  void check_property(std::string& name, const Class& of_class, io::UnreadableProperties& unreadable) const;
  void read_instances(const Json& described);
  void read_parents(const Json& described);
  void resolve(const core::ProgressReporter& progress);
  void settle(std::uint32_t instance);
  static void inherit(Instance& instance, const Instance& parent);
  std::uint32_t end_of_parents(std::uint32_t instance) const;
  std::string text(const Instance& instance, const std::string& property) const;

  std::string_view binary_;
  std::vector<Class> classes_;
  std::vector<Instance> instances_;
  std::vector<std::uint32_t> parents_;
};

}  // namespace vantage::internal::tiles
