// What killed processes leave of files and folders, and who removes it.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/temporary_file.h"
#include "support/random.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/atomic_file.h"
#include "vantage/error.h"
#include "vantage/temporary_folder.h"

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

TEST(TemporaryFolder, TakesThePlaceOfAnother) {
  const TemporaryDirectory directory;
  for (const std::string text : {"first", "second"}) {
    TemporaryFolder folder(directory.path(), ".x-");
    write_bytes(folder.path() / text, text);
    ASSERT_TRUE(folder.move_to(directory / "place"));
  }
  EXPECT_EQ(directory.names(), Names{"place"});
  EXPECT_TRUE(fs::exists(directory / "place/second"));
  EXPECT_FALSE(fs::exists(directory / "place/first"));
  TemporaryFolder folder(directory.path(), ".x-");
  EXPECT_FALSE(folder.move_to(directory / "none/place"));
}

}  // namespace
}  // namespace vantage::internal::core
