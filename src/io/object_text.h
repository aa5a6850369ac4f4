// Who the objects of a scene are, and its ledger (Scene::ledger): how readers fill it, and how both are written into
// scene files and read again. See docs/scene.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/mesh_file.h"
#include "vantage/scene.h"

namespace vantage::internal::io {

/// Whether the name that a file format has does not tell all.
bool says_more_than_name(const SceneObject& object);

/// {"name": …, "source_id": …, "kind": …} on one line; what is empty is left out.
std::string object_text(const SceneObject& object);

/// The comment of an OBJ file that holds it: "vantage object: {…}".
std::string object_comment(const SceneObject& object);

/// Reads what object_text has written. Nothing for what is garbled.
std::optional<SceneObject> parse_object(const nlohmann::json& written);

/// Reads the value of "object" in the object "vantage" of `extras`. Nothing where it is missing or garbled: the name in
/// the file then counts.
std::optional<SceneObject> object_in(const nlohmann::json& extras);

/// Likewise of the text of a comment, after its sign of a comment.
std::optional<SceneObject> object_in_comment(std::string_view comment);

/// An object of which a file says the name only. "ground" and "surface", the names that vantage gives to the ground of
/// maps and to rasters, are of these kinds: so other programs may pass such scenes on.
SceneObject object_named(std::string name);

// ---- the ledger

/// A closed box, faces outwards.
Mesh box_mesh(const Box& box);

/// The same of any eight corners, in the order of box_mesh: x counts first, z last.
Mesh hexahedron(std::vector<Vec3> corners);

/// Something that a box holds: `entry` gets the box, and "its box" as what stands in.
Missing held_by_box(LedgerEntry entry, const Box& box);

/// As `policy` says, of a mesh in the scene frame: the holders become objects of the kind stand_in, or what they would
/// hold is held by nothing. One that lies more than 100 km from all triangles is not built: its numbers are wrong. Of a
/// ledger that the file states a place is none that lies farther from them than they reach (1 km at least), or does not
/// meet what holds it; and an object holds it that is a stand-in or goes by its name, and reaches round its box, or
/// else nothing does. A stand-in that no entry names gets one. Throws Error(scene_incomplete) for MissingPolicy::refuse
/// where there is any entry.
void apply_policy(RawMesh& mesh, MissingPolicy policy, const std::filesystem::path& file,
                  const core::ProgressReporter& progress);

/// Throws Error(scene_incomplete), naming how many and the first, where there is any entry.
void refuse_incomplete(const std::vector<LedgerEntry>& ledger, const std::string& where);

/// Numbers of objects as a file counts them: those with triangles, from 0. In a file that does not tell objects apart
/// all of them are its only one.
enum class FileObjects { apart, one };

/// The entries of a scene, each {"object": {…}, "what": …, "reason": …, "box": [[…], […]], …} on one line.
std::vector<std::string> ledger_texts(const Scene& scene, FileObjects objects);

/// Lines for OBJ or the header of PLY: `start` ("# ", "comment ") and "vantage ledger: {…}".
std::string ledger_comments(const Scene& scene, FileObjects objects, const char* start);

/// Reads the text of a comment, after its sign of a comment, into `known` if it is ours. Throws LedgerProblem.
void read_ledger_comment(std::string_view comment, std::vector<Missing>& known);

/// The entries in "ledger" of the object "vantage" of a JSON object: glTF's "extras", files of their own. Throws
/// LedgerProblem for one that is garbled.
std::vector<Missing> ledger_in(const nlohmann::json& object);

/// What is wrong with an entry; whoever reads the file adds where it stands.
struct LedgerProblem {
  std::string text;
};

}  // namespace vantage::internal::io
