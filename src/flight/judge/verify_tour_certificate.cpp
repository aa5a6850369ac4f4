#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>
#include <utility>

#include "common/input.h"
#include "core/text.h"
#include "flight/judge/judged_proofs.h"
#include "flight/judge/region_file.h"
#include "vantage/error.h"
#include "vantage/mission_tour.h"
#include "vantage/volume.h"

namespace vantage {
namespace internal::flight::judge {
namespace {

constexpr std::uintmax_t kMostBytes = 1'000'000'000;
constexpr int kLeastBits = 90, kMostBits = 400;  // units of lengths
constexpr double kLargestM = 1e9;

[[noreturn]] void refuse_file(const std::filesystem::path& file, const std::string& problem) {
  throw Error(ErrorCode::record_garbled, problem, file.string(), "take the files that vantage tour wrote together");
}

/// Each key once.
Json parsed(const std::filesystem::path& file, const std::string& text) {
  if (std::any_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) > 127; })) {
    refuse_file(file, "a certificate is ASCII text, and this file is not");
  }
  std::vector<std::set<std::string>> keys;
  const auto event = [&](int, Json::parse_event_t kind, Json& value) {
    if (kind == Json::parse_event_t::object_start) keys.emplace_back();
    if (kind == Json::parse_event_t::object_end) keys.pop_back();
    if (kind == Json::parse_event_t::key) {
      demand(keys.back().insert(value.get<std::string>()).second, "a key is given twice");
    }
    return true;
  };
  return Json::parse(text, event);
}

class CertificateJudge {
 public:
  CertificateJudge(const std::filesystem::path& file, TourCertificateCheck& check,
                   const core::ProgressReporter& progress)
      : file_(file), check_(check), progress_(progress) {}

  /// Throws Refusal.
  void judge(Json json) {
    constexpr const char* kKeys[] = {"format", "bound_m", "turn_radius_m", "closed",
                                     "first",  "last",    "regions",       "proof"};
    if (const auto missing = json.find("scene_incomplete"); missing != json.end()) {
      check_.scene_incomplete = missing->get<std::string>();
      demand(!check_.scene_incomplete.empty(), "it says that the scene lacks nothing");
      json.erase(missing);
    }
    demand_keys(json, kKeys, "it has keys too many or too few");
    demand(json["format"] == "vantage tour certificate 2", "it is a certificate of another version");
    progress_.begin("regions of the certificate");
    for (const Json& region : list_of(json["regions"])) read_region(region);
    make_cells();
    read_ends(json);
    const BigInteger bound = whole_of(json["bound_m"], tour_.bits) * BigInteger(kUnit);
    check_.bound_m = json["bound_m"].get<double>();
    const Json& proof = json["proof"];
    check_.kind = proof.at("kind").get<std::string>();
    check_.nodes = list_of(proof.at("tree")).size();
    progress_.begin("proof of the bound");
    demand(check_.kind == "insertion" || check_.kind == "pairs", "it has a proof of no known kind");
    const std::optional<BigInteger> proved = check_.kind == "insertion" ? proved_by_insertion(tour_, proof, progress_)
                                                                        : proved_by_pairs(tour_, proof, progress_);
    progress_.finish();
    // No tour is shorter than 0, and none at all is shorter than anything.
    const BigInteger most = proved ? std::max(*proved, BigInteger()) : std::max(bound, BigInteger());
    check_.proved_m = proved ? most.scaled_down(tour_.bits + kUnitBits) : std::numeric_limits<double>::infinity();
    demand(bound <= most, "less is proved than it says");
  }

 private:
  static constexpr int kUnitBits = 30;
  static_assert(kUnit == std::int64_t{1} << kUnitBits);

  void read_region(const Json& region) {
    const auto& kind = region.at("kind").get_ref<const std::string&>();
    TourCertificateRegion& read = check_.regions.emplace_back();
    read.name = region.at("name").get<std::string>();
    dwell_.push_back(region.at("dwell_m"));
    Mesh mesh;
    if (kind == "point") {
      constexpr const char* kKeys[] = {"name", "kind", "dwell_m", "at"};
      demand_keys(region, kKeys, "a place has keys too many or too few");
      read.kind = TourCertificateRegion::Kind::point;
      list_of(region["at"], 3);
      Vec3& at = mesh.vertices.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        demand(region["at"][k].is_number(), "a place is no point");
        at[static_cast<Eigen::Index>(k)] = region["at"][k].get<double>();
      }
      demand(at.cwiseAbs().maxCoeff() <= kLargestM, "a place is too far away");
    } else {
      demand(kind == "outer" || kind == "given", "a region is of a kind that no bound can be over");
      constexpr const char* kKeys[] = {"name", "kind", "dwell_m", "file", "hash"};
      demand_keys(region, kKeys, "a region has keys too many or too few");
      read.kind = kind == "outer" ? TourCertificateRegion::Kind::outer : TourCertificateRegion::Kind::given;
      const auto name = region["file"].get<std::string>();
      demand(is_plain_name(name), "a mesh lies in another folder");
      read.file = file_.parent_path() / name;
      mesh = read_region_mesh(read.file, kind);
      demand(region["hash"] == volume_hash(mesh), "a mesh is not the region that it is about");
    }
    meshes_.push_back(std::move(mesh));
  }

  /// Letters, digits, "_.-".
  static bool is_plain_name(std::string_view name) {
    return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.' ||
             c == '-';
    });
  }

  /// In units so fine that all corners are whole.
  void make_cells() {
    tour_.bits = kLeastBits;
    for (const Mesh& mesh : meshes_) {
      std::vector<bool> is_used(mesh.vertices.size(), mesh.triangles.empty());
      for (const Triangle& triangle : mesh.triangles) {
        for (const std::uint32_t corner : triangle) is_used[corner] = true;
      }
      for (std::size_t v = 0; v < is_used.size(); ++v) {
        if (!is_used[v]) continue;
        for (const double x : mesh.vertices[v]) tour_.bits = std::max(tour_.bits, fraction_bits(x));
      }
    }
    demand(tour_.bits <= kMostBits, "a coordinate is too fine");
    corners_.emplace(tour_.bits);
    for (const Mesh& mesh : meshes_) {
      progress_.report(tour_.cells.size(), meshes_.size());
      tour_.cells.push_back(cell_of(mesh));
    }
  }

  std::unique_ptr<Cell> cell_of(const Mesh& mesh) {
    constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> number(mesh.vertices.size(), kNone), polygons, ends;
    const auto add = [&](std::uint32_t vertex) {
      if (number[vertex] == kNone) {
        WholePoint point;
        for (std::size_t k = 0; k < 3; ++k) {
          point[k] = BigInteger::scaled(mesh.vertices[vertex][static_cast<Eigen::Index>(k)], tour_.bits);
        }
        number[vertex] = corners_->add(std::move(point), BigInteger(1));
      }
      polygons.push_back(number[vertex]);
    };
    for (const Triangle& triangle : mesh.triangles) {
      for (const std::uint32_t corner : triangle) add(corner);
      ends.push_back(static_cast<std::uint32_t>(polygons.size()));
    }
    if (mesh.triangles.empty()) {
      add(0);
      ends.push_back(1);
    }
    return std::make_unique<Cell>(*corners_, tour_.cells.size(), std::move(polygons), std::move(ends), false);
  }

  void read_ends(const Json& json) {
    for (std::size_t r = 0; r < dwell_.size(); ++r) {
      tour_.dwell.push_back(whole_of(dwell_[r], tour_.bits));
      demand(tour_.dwell.back().sign() >= 0, "a stay is of negative length");
      check_.regions[r].dwell_m = dwell_[r].get<double>();
      tour_.is_place.push_back(check_.regions[r].kind == TourCertificateRegion::Kind::point);
    }
    tour_.turn_radius = whole_of(json["turn_radius_m"], tour_.bits);
    demand(tour_.turn_radius.sign() >= 0, "a turn radius is negative");
    check_.turn_radius_m = json["turn_radius_m"].get<double>();
    demand(json["closed"].is_boolean(), "it is of tours that are neither closed nor open");
    tour_.closed = check_.closed = json["closed"].get<bool>();
    for (const char* key : {"first", "last"}) {
      if (!json[key].is_null()) tour_.ends.push_back(index_of(json[key], tour_.cells.size()));
    }
    demand(tour_.ends.size() < 2 || tour_.ends[0] != tour_.ends[1], "one region is both ends");
    demand(tour_.closed ? tour_.ends.empty() : !json["first"].is_null(), "its tours have ends that they cannot have");
    for (const std::size_t end : tour_.ends) {
      demand(tour_.is_place[end] && tour_.dwell[end].sign() == 0, "an end is no place");
    }
  }

  const std::filesystem::path& file_;
  TourCertificateCheck& check_;
  const core::ProgressReporter& progress_;
  std::vector<Mesh> meshes_;
  std::vector<Json> dwell_;
  std::optional<Corners> corners_;
  JudgedTour tour_;
};

}  // namespace
}  // namespace internal::flight::judge

const char* name_of(TourCertificateRegion::Kind kind) {
  switch (kind) {
    case TourCertificateRegion::Kind::outer:
      return "outer";
    case TourCertificateRegion::Kind::given:
      return "given";
    case TourCertificateRegion::Kind::point:
      return "point";
  }
  return "";
}

TourCertificateCheck verify_tour_certificate(const std::filesystem::path& file, const Progress& progress) {
  namespace judge = internal::flight::judge;
  check_readable(file, "the certificate");
  const internal::core::ProgressReporter reporter(progress, file.string());
  TourCertificateCheck check;
  try {
    judge::Json json = judge::parsed(file, judge::bytes_of(file, judge::kMostBytes));
    judge::CertificateJudge(file, check, reporter).judge(std::move(json));
    check.is_accepted = true;
  } catch (const judge::Refusal& refusal) {
    check.reason = refusal.what();
  } catch (const nlohmann::json::exception& error) {
    judge::refuse_file(file, std::string("it is no certificate of a tour: ") + error.what());
  } catch (const std::length_error&) {
    throw Error(ErrorCode::work_too_large, "to judge the certificate takes more memory than any honest one does",
                file.string(), "write the certificate anew with vantage tour");
  }
  return check;
}

std::string json_text(const TourCertificateCheck& check) {
  using Ordered = nlohmann::ordered_json;
  Ordered json;
  json["accepted"] = check.is_accepted;
  json["reason"] = check.reason;
  json["bound_m"] = check.bound_m;
  json["proved_m"] = nullptr;
  if (check.proved_m && std::isfinite(*check.proved_m)) json["proved_m"] = *check.proved_m;
  json["turn_radius_m"] = check.turn_radius_m;
  json["closed"] = check.closed;
  json["proof"] = check.kind;
  json["nodes"] = check.nodes;
  json["regions"] = Ordered::array();
  for (const TourCertificateRegion& region : check.regions) {
    json["regions"].push_back({{"name", region.name}, {"kind", name_of(region.kind)}, {"dwell_m", region.dwell_m}});
  }
  json["scene_incomplete"] = check.scene_incomplete.empty() ? Ordered() : Ordered(check.scene_incomplete);
  constexpr int kIndentation = 2;
  return internal::core::escaped_json(json.dump(kIndentation, ' ', false, Ordered::error_handler_t::replace)) + "\n";
}

}  // namespace vantage
