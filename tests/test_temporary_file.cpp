// What killed processes leave of files and folders, and who removes it.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "common/atomic_file.h"
#include "common/stages.h"
#include "common/temporary_folder.h"
#include "core/replace_folder.h"
#include "core/temporary_file.h"
#include "core/temporary_mark.h"
#include "support/random.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"

namespace vantage::internal::core {
namespace {

using vantage::testing::read_bytes;
using vantage::testing::TemporaryDirectory;
using vantage::testing::write_bytes;
using Names = std::vector<std::string>;
namespace fs = std::filesystem;

constexpr auto kNamed = TemporaryFile::Names::from_the_start;

Names sorted_names(const TemporaryDirectory& directory) {
  Names names = directory.names();
  std::sort(names.begin(), names.end());
  return names;
}

Names names_in(const fs::path& folder) {
  Names names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  return names;
}

void write_to(const TemporaryFile& file, const std::string& text) {
  ASSERT_EQ(::write(file.descriptor(), text.data(), text.size()), static_cast<ssize_t>(text.size()));
}

/// Another process that does something and then waits, until it is killed.
class Process {
 public:
  explicit Process(const std::function<void()>& work) {
    int ends[2];
    if (::pipe(ends) != 0) return;
    id_ = ::fork();
    if (id_ == 0) {
      work();
      (void)!::write(ends[1], "x", 1);
      for (;;) ::pause();
    }
    ::close(ends[1]);
    char done = 0;
    (void)!::read(ends[0], &done, 1);
    ::close(ends[0]);
  }
  ~Process() { kill(); }
  void kill() {
    if (id_ <= 0) return;
    ::kill(id_, SIGKILL);
    ::waitpid(id_, nullptr, 0);
    id_ = 0;
  }

 private:
  pid_t id_ = 0;
};

bool keeps_files_without_name(const TemporaryDirectory& directory) {
  const int descriptor = ::open(directory.path().c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor >= 0) ::close(descriptor);
  return descriptor >= 0;
}

TEST(TemporaryFile, HasNoNameUntilItIsPutInPlace) {
  const TemporaryDirectory directory;
  if (!keeps_files_without_name(directory)) GTEST_SKIP() << "this file system names all files";
  TemporaryFile file(directory / "a.ply");
  write_to(file, "new");
  EXPECT_EQ(directory.names(), Names{});
  Process writer([&] {
    AtomicFile other(directory / "b.ply");
    other.write(std::string(3 << 20, 'x'));
    other.seal();
    new AtomicFile(directory / "c.ply");
  });
  EXPECT_EQ(directory.names(), Names{});
  file.put_in_place();
  EXPECT_EQ(directory.names(), Names{"a.ply"});
  EXPECT_EQ(read_bytes(directory / "a.ply"), "new");
  struct stat status {};
  ASSERT_EQ(::stat((directory / "a.ply").c_str(), &status), 0);
  const mode_t mask = ::umask(0);
  ::umask(mask);
  EXPECT_EQ(status.st_mode & 0777, 0666 & ~mask);
}

TEST(TemporaryFile, WhatAKilledProcessLeftIsRemovedByTheNext) {
  const TemporaryDirectory directory;
  write_bytes(directory / "a.ply", "old");
  Process writer([&] {
    for (int i = 0; i < 2; ++i) (new TemporaryFile(directory / "a.ply", kNamed))->keep_old();
  });
  const Names left = {".a.ply.vantage-0.old", ".a.ply.vantage-0.tmp", ".a.ply.vantage-1.old", ".a.ply.vantage-1.tmp",
                      "a.ply"};
  EXPECT_EQ(sorted_names(directory), left);
  {  // it lives: its files stay, and others find room
    TemporaryFile file(directory / "a.ply", kNamed);
    file.keep_old();
    EXPECT_EQ(directory.names().size(), 7U);
  }
  write_whole_file(directory / "b.ply", "another");
  EXPECT_EQ(directory.names().size(), 6U);
  writer.kill();
  EXPECT_EQ(directory.names().size(), 6U);
  write_whole_file(directory / "a.ply", "new");
  EXPECT_EQ(sorted_names(directory), (Names{"a.ply", "b.ply"}));
  EXPECT_EQ(read_bytes(directory / "a.ply"), "new");
}

TEST(TemporaryFile, OnlyFilesThatNobodyHoldsAreRemoved) {
  const TemporaryDirectory directory;
  fs::create_directory(directory / "folder");
  write_bytes(directory / "file", "precious");
  fs::create_symlink("file", directory / "link");
  remove_if_abandoned(directory / "folder");
  remove_if_abandoned(directory / "link");
  remove_if_abandoned(directory / "none");
  const TemporaryFile held(directory / "a", kNamed);
  remove_if_abandoned(directory / ".a.vantage-0.tmp");
  EXPECT_EQ(sorted_names(directory), (Names{".a.vantage-0.tmp", "file", "folder", "link"}));
  remove_if_abandoned(directory / "file");
  EXPECT_FALSE(fs::exists(directory / "file"));
}

TEST(TemporaryFile, AsManyAsThereAreNamesMayBeWrittenAtOnce) {
  const TemporaryDirectory directory;
  std::vector<std::unique_ptr<TemporaryFile>> files;
  for (int i = 0; i < 256; ++i) files.push_back(std::make_unique<TemporaryFile>(directory / "a", kNamed));
  EXPECT_EQ(directory.names().size(), 256U);
  EXPECT_THROW(TemporaryFile(directory / "a", kNamed), std::system_error);
  files[17].reset();
  EXPECT_NO_THROW(TemporaryFile(directory / "a", kNamed));
}

TEST(TemporaryFile, FartherNumbersAreLookedAtBehindThoseInUse) {
  const TemporaryDirectory directory;
  Process writer([&] {
    for (int i = 0; i < 12; ++i) new TemporaryFile(directory / "a", kNamed);
  });
  ASSERT_EQ(directory.names().size(), 12U);
  writer.kill();
  { const TemporaryFile next(directory / "a"); }
  EXPECT_EQ(directory.names(), Names{});
}

TEST(TemporaryFile, WhatTookItsNameIsNeitherPutInPlaceNorRemoved) {
  const TemporaryDirectory directory;
  write_bytes(directory / "a", "old");
  const fs::path name = directory / ".a.vantage-0.tmp";
  {
    TemporaryFile file(directory / "a", kNamed);
    write_to(file, "new");
    fs::remove(name);
    write_bytes(name, "of somebody else");
    EXPECT_THROW(file.put_in_place(), std::system_error);
  }
  EXPECT_EQ(read_bytes(directory / "a"), "old");
  EXPECT_EQ(read_bytes(name), "of somebody else");
}

TEST(TemporaryFile, WhatTookTheSecondNameOfTheOldOneIsNotGivenBack) {
  const TemporaryDirectory directory;
  write_bytes(directory / "a", "old");
  const fs::path name = directory / ".a.vantage-0.old";
  {
    TemporaryFile file(directory / "a", kNamed);
    file.keep_old();
    ASSERT_TRUE(fs::exists(name));
    fs::remove(name);
    write_bytes(name, "of somebody else");
    EXPECT_FALSE(file.give_back());
  }
  EXPECT_EQ(read_bytes(directory / "a"), "old");
  EXPECT_EQ(read_bytes(name), "of somebody else");
}

struct OldFileInSteps : TemporaryFile {
  using TemporaryFile::hold_old;
  using TemporaryFile::link_old_as;
  using TemporaryFile::TemporaryFile;
};

/// Another process puts a new file in place after the old one was opened, and before it is linked.
TEST(TemporaryFile, TheOldFileThatIsKeptIsTheOneThatIsHeld) {
  const TemporaryDirectory directory;
  write_bytes(directory / "a", "first");
  write_bytes(directory / "next", "second");
  const fs::path kept = directory / ".a.vantage-0.old";
  OldFileInSteps file(directory / "a", kNamed);
  ASSERT_TRUE(file.hold_old());
  fs::rename(directory / "next", directory / "a");
  EXPECT_EQ(file.link_old_as(kept), EAGAIN);
  EXPECT_FALSE(fs::exists(kept));
  EXPECT_FALSE(file.give_back());
  file.keep_old();
  EXPECT_EQ(read_bytes(kept), "second");
  file.put_in_place();
  ASSERT_TRUE(file.give_back());
  EXPECT_EQ(read_bytes(directory / "a"), "second");
}

TEST(TemporaryFile, IsCopiedWhereItCannotBeGivenAName) {
  const TemporaryDirectory directory;
  write_bytes(directory / "a", "old");
  const std::string text(200'000, 'n');
  {
    TemporaryFile file(directory / "a", TemporaryFile::Names::by_copy);
    write_to(file, text);
    ASSERT_EQ(::fchmod(file.descriptor(), 0640), 0);
    file.put_in_place();
  }
  EXPECT_EQ(read_bytes(directory / "a"), text);
  struct stat status {};
  ASSERT_EQ(::stat((directory / "a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640U);
  EXPECT_EQ(directory.names(), Names{"a"});
}

TEST(TemporaryFile, AnOldFileThatCannotBeReadHasNoWayBack) {
  const TemporaryDirectory directory;
  TemporaryFile file(directory / "a");
  file.keep_old();  // there is none
  EXPECT_FALSE(file.give_back());
}

/// Sets of files are written over and over, by a process that is killed at any moment, and by the next one.
TEST(AtomicFile, TwentyKillsLeaveWholeFilesAndNothingElse) {
  testing::Random random(2026);
  const TemporaryDirectory directory;
  const Names names = {"a.ply", "b.ply", "c.ply"};
  const std::string old_text(100'000, 'o'), new_text(400'000, 'n');
  for (int kill = 0; kill < 20; ++kill) {
    for (const std::string& name : names) write_bytes(directory / name, old_text);
    {
      Process writer([&] {
        std::thread([&] {
          for (;;) {
            std::vector<std::unique_ptr<AtomicFile>> files;
            for (const std::string& name : names) files.push_back(std::make_unique<AtomicFile>(directory / name));
            for (const auto& file : files) file->write(new_text);
            commit_all(files);
          }
        }).detach();
      });
      std::this_thread::sleep_for(std::chrono::microseconds(random.integer(0, 30'000)));
    }
    for (const std::string& name : names) {
      const std::string text = read_bytes(directory / name);
      EXPECT_TRUE(text == old_text || text == new_text) << name << " after kill " << kill << ": " << text.size();
    }
    EXPECT_LE(directory.names().size(), names.size() + 4) << "one name of each kind, at most, for one or two files";
    for (const std::string& name : names) write_whole_file(directory / name, new_text);
    EXPECT_EQ(sorted_names(directory), names) << "after kill " << kill;
  }
}

TEST(TemporaryFolder, GoesWithTheObjectOrWithTheNextOne) {
  const TemporaryDirectory directory;
  fs::path left;
  Process writer([&] {
    const auto* const folder = new TemporaryFolder(directory.path(), ".x-");
    fs::create_directory(folder->path() / "deep");
    write_bytes(folder->path() / "deep/file", "x");
  });
  ASSERT_EQ(directory.names().size(), 1U);
  {
    const TemporaryFolder mine(directory.path(), ".x-");
    EXPECT_EQ(directory.names().size(), 2U) << "that of a process that lives stays";
    struct stat status {};
    ASSERT_EQ(::stat(mine.path().c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0700U);
  }
  EXPECT_EQ(directory.names().size(), 1U);
  writer.kill();
  { const TemporaryFolder other(directory.path(), ".y-"); }
  EXPECT_EQ(directory.names().size(), 1U) << "another kind";
  fs::create_directory(directory / ".x-longer-name");
  write_bytes(directory / ".x-abcdef", "a file");
  { const TemporaryFolder mine(directory.path(), ".x-"); }
  EXPECT_EQ(sorted_names(directory), (Names{".x-abcdef", ".x-longer-name"}));
  testing::expect_code([&] { TemporaryFolder(directory / "none", "x-"); }, ErrorCode::output_unwritable, "none");
}

/// A folder with the mark in it.
void make_marked(const fs::path& folder) {
  fs::create_directory(folder);
  const int opened = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  EXPECT_TRUE(put_temporary_mark(opened));
  ::close(opened);
}

// A name alone shows nothing: "vantage-tmp-backup" is also one that people give.
TEST(TemporaryFolder, LeavesFoldersThatVantageDidNotMake) {
  const TemporaryDirectory directory;
  make_marked(directory / ".x-mymark");
  const std::string mark = read_bytes(directory / ".x-mymark" / kTemporaryMark);
  ASSERT_GT(mark.size(), 20U);
  for (const char* name : {"backup", "wrongs", "longer", "linked", "folder"}) {
    const fs::path folder = directory / (std::string(".x-") + name);
    fs::create_directory(folder);
    write_bytes(folder / "city.osm.pbf", "mine");
  }
  write_bytes(directory / ".x-wrongs" / kTemporaryMark, "my notes");
  write_bytes(directory / ".x-longer" / kTemporaryMark, mark + "x");
  write_bytes(directory / "mark", mark);
  fs::create_symlink(directory / "mark", directory / ".x-linked" / kTemporaryMark);
  fs::create_directory(directory / ".x-folder" / kTemporaryMark);
  { const TemporaryFolder mine(directory.path(), ".x-"); }
  EXPECT_EQ(sorted_names(directory), (Names{".x-backup", ".x-folder", ".x-linked", ".x-longer", ".x-wrongs", "mark"}));
  for (const char* name : {".x-backup", ".x-wrongs", ".x-longer", ".x-linked", ".x-folder"}) {
    EXPECT_EQ(read_bytes(directory / name / "city.osm.pbf"), "mine") << name;
  }
}

/// As mkdtemp makes it.
void make_private(const fs::path& folder) {
  fs::create_directory(folder);
  fs::permissions(folder, fs::perms::owner_all);
}

TEST(TemporaryFolder, RemovesThoseOfProcessesThatWereKilledBeforeTheMarkWasWhole) {
  const TemporaryDirectory directory;
  make_marked(directory / ".x-mymark");
  const std::string mark = read_bytes(directory / ".x-mymark" / kTemporaryMark), half = mark.substr(0, mark.size() / 2);
  for (const char* name : {".x-nothin", ".x-nobyte", ".x-onlyhf", ".x-halfof", ".x-wrongs", ".x-linked"})
    make_private(directory / name);
  write_bytes(directory / ".x-nobyte" / kTemporaryMark, "");
  write_bytes(directory / ".x-onlyhf" / kTemporaryMark, half);
  write_bytes(directory / ".x-halfof" / kTemporaryMark, half);
  write_bytes(directory / ".x-halfof" / "notes.txt", "mine");
  write_bytes(directory / ".x-wrongs" / kTemporaryMark, "my notes");
  write_bytes(directory / "half", half);
  fs::create_symlink(directory / "half", directory / ".x-linked" / kTemporaryMark);
  { const TemporaryFolder mine(directory.path(), ".x-"); }
  EXPECT_EQ(sorted_names(directory), (Names{".x-halfof", ".x-linked", ".x-wrongs", "half"}));
  EXPECT_EQ(read_bytes(directory / ".x-halfof" / kTemporaryMark), half);
}

// "mkdir vantage-tmp-backup", and then something is copied there.
TEST(TemporaryFolder, LeavesAnEmptyFolderThatSomebodyElseMade) {
  const TemporaryDirectory directory;
  fs::create_directory(directory / ".x-backup");
  fs::permissions(directory / ".x-backup", fs::perms(0755));
  { const TemporaryFolder mine(directory.path(), ".x-"); }
  EXPECT_EQ(sorted_names(directory), (Names{".x-backup"}));
}

TEST(TemporaryFolder, IsRemovedWithoutFollowingLinks) {
  const TemporaryDirectory directory;
  fs::create_directory(directory / "mine");
  write_bytes(directory / "mine/file", "mine");
  {
    const TemporaryFolder folder(directory.path(), ".x-");
    fs::create_directories(folder.path() / "deep/deeper");
    write_bytes(folder.path() / "deep/deeper/file", "x");
    fs::create_directory_symlink(directory / "mine", folder.path() / "deep/link");
  }
  EXPECT_EQ(directory.names(), Names{"mine"});
  EXPECT_EQ(read_bytes(directory / "mine/file"), "mine");
}

TEST(TemporaryFolder, TakesThePlaceOfAnother) {
  const TemporaryDirectory directory;
  for (const std::string text : {"first", "second"}) {
    TemporaryFolder folder(directory.path(), ".x-");
    write_bytes(folder.path() / text, text);
    ASSERT_TRUE(folder.move_to(directory / "place"));
  }
  EXPECT_EQ(directory.names(), Names{"place"});
  EXPECT_EQ(names_in(directory / "place"), Names{"second"}) << "and no mark";
  TemporaryFolder folder(directory.path(), ".x-");
  EXPECT_FALSE(folder.move_to(directory / "none/place"));
  EXPECT_EQ(names_in(folder.path()), Names{kTemporaryMark}) << "it is still a temporary one";
}

/// Whenever it is killed, the next one removes all that is left, but for a folder in which there is nothing yet.
TEST(TemporaryFolder, NoKillWhileItTakesThePlaceOfAnotherLeavesAFolder) {
  testing::Random random(2027);
  for (int kill = 0; kill < 60; ++kill) {
    const TemporaryDirectory directory;
    {
      Process mover([&] {
        std::thread([&] {
          for (;;) {
            TemporaryFolder folder(directory.path(), ".x-");
            write_bytes(folder.path() / "file", "x");
            folder.move_to(directory / "place");
          }
        }).detach();
      });
      std::this_thread::sleep_for(std::chrono::microseconds(random.integer(0, 5'000)));
    }
    {
      TemporaryFolder next(directory.path(), ".x-");
      write_bytes(next.path() / "file", "y");
      ASSERT_TRUE(next.move_to(directory / "place"));
    }
    EXPECT_EQ(names_in(directory / "place"), Names{"file"}) << "after kill " << kill;
    EXPECT_EQ(read_bytes(directory / "place/file"), "y");
    for (const std::string& name : directory.names()) {
      EXPECT_TRUE(name == "place" || !fs::exists(directory / name / "file")) << name << " after kill " << kill;
    }
  }
}

/// A finished folder may keep the mark where the process was killed: it must not be taken for a temporary one.
TEST(TemporaryFolder, DoesNotMoveToANameOfItsOwnKind) {
  const TemporaryDirectory directory;
  for (const char* const name : {".x-abcdef", ".x-abcdef-old"}) {
    TemporaryFolder folder(directory.path(), ".x-");
    EXPECT_FALSE(folder.move_to(directory / name));
    EXPECT_EQ(errno, EINVAL);
    EXPECT_FALSE(fs::exists(directory / name));
  }
  EXPECT_EQ(directory.names(), Names{});
}

TEST(TemporaryFolder, AMarkThatWasLeftInAFinishedFolderIsTakenAway) {
  const TemporaryDirectory directory;
  make_marked(directory / "place");
  write_bytes(directory / "place/stages.json",
              R"({"version": "0.0.1", "mission": "", "outcome": "computed", "run": {}, "stages": []})");
  { const StageFolder accepted(directory / "place"); }
  {
    TemporaryFolder folder(directory.path(), ".x-");
    write_bytes(folder.path() / "file", "x");
    EXPECT_FALSE(folder.move_to(directory / "none/place"));
    ASSERT_TRUE(folder.move_to(directory / "place"));
  }
  EXPECT_EQ(directory.names(), Names{"place"});
  EXPECT_EQ(names_in(directory / "place"), Names{"file"});
}

/// Without an exchange in one step, as on some network file systems.
TEST(TemporaryFolder, TakesThePlaceOfAnotherInTwoSteps) {
  const TemporaryDirectory directory;
  for (const std::string text : {"first", "second"}) {
    fs::create_directory(directory / "new");
    write_bytes(directory / "new" / text, text);
    ASSERT_TRUE(replace_folder(directory / "new", directory / "place", false));
    EXPECT_EQ(directory.names(), Names{"place"});
  }
  EXPECT_TRUE(fs::exists(directory / "place/second"));
  EXPECT_FALSE(fs::exists(directory / "place/first"));
  EXPECT_FALSE(replace_folder(directory / "none", directory / "place", false));
  EXPECT_EQ(errno, ENOENT);
  EXPECT_EQ(names_in(directory / "place"), Names{"second"}) << "the old one is back, without a mark";
  EXPECT_EQ(directory.names(), Names{"place"});
}

TEST(TemporaryFolder, TheOldOneThatWasLeftAsideGoesWhenANewOneIsInPlace) {
  const TemporaryDirectory directory;
  make_marked(directory / ".x-abcdef-old");
  write_bytes(directory / ".x-abcdef-old/file", "x");
  make_marked(directory / ".y-abcdef-old");
  fs::create_directory(directory / ".x-mydata-old");
  {
    TemporaryFolder folder(directory.path(), ".x-");
    EXPECT_TRUE(fs::exists(directory / ".x-abcdef-old/file")) << "until then it is the only one";
    ASSERT_TRUE(folder.move_to(directory / "place"));
  }
  EXPECT_EQ(sorted_names(directory), (Names{".x-mydata-old", ".y-abcdef-old", "place"}));
}

TEST(TemporaryFolder, OfStagesIsMadeBesideAFolderOfALongName) {
  const TemporaryDirectory directory;
  for (const std::size_t length : {1U, 180U, 181U, 255U}) {
    const StageFolder stages(directory / std::string(length, 's'));
    EXPECT_EQ(directory.names().size(), 1U) << length;
  }
  const StageFolder one(directory / (std::string(200, 's') + "1")), two(directory / (std::string(200, 's') + "2"));
  const Names names = directory.names();
  ASSERT_EQ(names.size(), 2U);
  EXPECT_NE(names[0].substr(0, names[0].size() - 6), names[1].substr(0, names[1].size() - 6)) << "each has its prefix";
  testing::expect_code([&] { StageFolder(directory / "none/stages"); }, ErrorCode::output_unwritable, "none/stages");
}

TEST(TemporaryFolder, LeavesNothingWhenNoFileCanBeOpened) {
  const TemporaryDirectory directory;
  rlimit old{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &old), 0);
  const rlimit none{0, old.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
  bool is_refused = false;
  try {
    const TemporaryFolder folder(directory.path(), ".x-");
  } catch (const Error& error) {
    is_refused = error.code() == ErrorCode::output_unwritable;
  }
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &old), 0);
  EXPECT_TRUE(is_refused);
  EXPECT_EQ(directory.names(), Names{});
}

}  // namespace
}  // namespace vantage::internal::core
