#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "support/solids.h"
#include "support/temporary_directory.h"
#include "vantage/atomic_file.h"
#include "vantage/error.h"
#include "vantage/volume.h"

namespace vantage::internal::core {
namespace {

using vantage::testing::read_bytes;
using vantage::testing::TemporaryDirectory;
using vantage::testing::write_bytes;
using Names = std::vector<std::string>;

const std::string kLong(3 << 20, 'x');  // larger than the buffer

/// The error that `action` throws; fails the test when it throws none.
template <typename Action>
Error error_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "nothing was thrown";
  return {ErrorKind::internal, "", "", ""};
}

TEST(AtomicFile, WritesAndReplaces) {
  const TemporaryDirectory directory;
  write_whole_file(directory / "out.json", "first");
  EXPECT_EQ(read_bytes(directory / "out.json"), "first");
  write_whole_file(directory / "out.json", kLong);
  EXPECT_EQ(read_bytes(directory / "out.json"), kLong);
  write_whole_file(directory / "out.json", "");
  EXPECT_EQ(read_bytes(directory / "out.json"), "");
  EXPECT_EQ(directory.names(), Names{"out.json"});
}

TEST(AtomicFile, LeavesTheOldFileUntilCommit) {
  const TemporaryDirectory directory;
  write_bytes(directory / "out.ply", "old");
  {
    AtomicFile file(directory / "out.ply");
    file.write(kLong);
    EXPECT_EQ(read_bytes(directory / "out.ply"), "old");
    EXPECT_EQ(directory.names().size(), 2u);
  }
  EXPECT_EQ(read_bytes(directory / "out.ply"), "old");
  EXPECT_EQ(directory.names(), Names{"out.ply"});
}

TEST(AtomicFile, ASetIsCommittedAsOne) {
  const TemporaryDirectory directory;
  write_bytes(directory / "a.ply", "old");
  std::vector<std::unique_ptr<AtomicFile>> files;
  for (const std::string name : {"a.ply", "b.ply"}) {
    files.push_back(std::make_unique<AtomicFile>(directory / name));
    files.back()->write(kLong);
  }
  files.front()->seal();  // that some are on the disk already makes no difference
  commit_all(files);
  EXPECT_EQ(read_bytes(directory / "a.ply"), kLong);
  EXPECT_EQ(read_bytes(directory / "b.ply"), kLong);
  files.clear();
  EXPECT_EQ(directory.names().size(), 2u);
  commit_all({});
}

TEST(AtomicFile, ASetOfWhichOneCannotBePutInPlaceLeavesEverythingAsItWas) {
  const TemporaryDirectory directory;
  for (const std::string name : {"a.ply", "d.ply"}) write_bytes(directory / name, "old");
  std::vector<std::unique_ptr<AtomicFile>> files;
  for (const std::string name : {"a.ply", "b.ply", "c.ply", "d.ply"}) {
    files.push_back(std::make_unique<AtomicFile>(directory / name));
    files.back()->write("new");
  }
  std::filesystem::create_directory(directory / "c.ply");  // a and b are in place by the time this is noticed
  const Error error = error_of([&] { commit_all(files); });
  EXPECT_EQ(error.kind(), ErrorKind::output);
  EXPECT_EQ(error.problem(), "cannot put the file in place: Is a directory");
  EXPECT_EQ(error.where(), (directory / "c.ply").string());
  EXPECT_EQ(error.fix().find("already replaced"), std::string::npos);
  files.clear();
  EXPECT_EQ(read_bytes(directory / "a.ply"), "old");
  EXPECT_EQ(read_bytes(directory / "d.ply"), "old");
  Names names = directory.names();
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (Names{"a.ply", "c.ply", "d.ply"}));
}

TEST(AtomicFile, RefusesADirectory) {
  const TemporaryDirectory directory;
  const Error error = error_of([&] { AtomicFile file(directory.path()); });
  EXPECT_EQ(error.kind(), ErrorKind::input);
  EXPECT_EQ(error.problem(), "the output is a directory");
  EXPECT_EQ(error.where(), directory.path().string());
  EXPECT_FALSE(error.fix().empty());
  EXPECT_EQ(error_of([&] { AtomicFile file(directory / "new/"); }).problem(), "the output is a directory");
  EXPECT_EQ(error_of([&] { AtomicFile file(""); }).kind(), ErrorKind::input);
  EXPECT_TRUE(directory.names().empty());
}

TEST(AtomicFile, RefusesAMissingDirectory) {
  const TemporaryDirectory directory;
  const Error error = error_of([&] { write_whole_file(directory / "no/such/out.ply", "x"); });
  EXPECT_EQ(error.kind(), ErrorKind::output);
  EXPECT_EQ(error.problem(), "cannot create the file: No such file or directory");
  EXPECT_EQ(error.fix(), "create the directory or name another");
}

TEST(AtomicFile, RefusesDevicesAndPipes) {
  const TemporaryDirectory directory;
  EXPECT_EQ(error_of([] { write_whole_file("/dev/full", "x"); }).kind(), ErrorKind::output);
  ASSERT_EQ(::mkfifo((directory / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(error_of([&] { write_whole_file(directory / "pipe", "x"); }).kind(), ErrorKind::output);
  EXPECT_EQ(directory.names(), Names{"pipe"});
}

TEST(AtomicFile, FollowsLinksAndKeepsPermissions) {
  const TemporaryDirectory directory;
  write_bytes(directory / "real.ply", "old");
  ASSERT_EQ(::chmod((directory / "real.ply").c_str(), 0640), 0);
  std::filesystem::create_symlink("real.ply", directory / "link.ply");
  write_whole_file(directory / "link.ply", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(directory / "link.ply"));
  EXPECT_EQ(read_bytes(directory / "real.ply"), "new");
  struct stat status {};
  ASSERT_EQ(::stat((directory / "real.ply").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640u);
  std::filesystem::create_symlink("loop", directory / "loop");
  EXPECT_EQ(error_of([&] { write_whole_file(directory / "loop", "x"); }).kind(), ErrorKind::output);
}

TEST(AtomicFile, RefusesWhatMayNotBeWritten) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const TemporaryDirectory directory;
  write_bytes(directory / "out.ply", "old");
  ASSERT_EQ(::chmod((directory / "out.ply").c_str(), 0444), 0);
  EXPECT_EQ(error_of([&] { write_whole_file(directory / "out.ply", "new"); }).kind(), ErrorKind::output);
  EXPECT_EQ(read_bytes(directory / "out.ply"), "old");
}

TEST(AtomicFile, ThreadsDoNotMeet) {
  const TemporaryDirectory directory;
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back(
        [&, i] { write_whole_file(directory / "out", std::string(2 << 20, static_cast<char>('a' + i))); });
  }
  for (std::thread& thread : threads) thread.join();
  const std::string bytes = read_bytes(directory / "out");
  EXPECT_EQ(bytes, std::string(2 << 20, bytes[0]));
  EXPECT_EQ(directory.names(), Names{"out"});
}

/// No file may grow beyond `bytes` while this lives.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    old_handler_ = ::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{bytes, old_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &old_);
    ::signal(SIGXFSZ, old_handler_);
  }

 private:
  rlimit old_{};
  void (*old_handler_)(int) = nullptr;
};

TEST(AtomicFile, AFileThatCannotGrowLeavesTheOldOne) {
  const TemporaryDirectory directory;
  write_bytes(directory / "out.ply", "old");
  const Error error = error_of([&] {
    const FileSizeLimit limit(100000);
    write_whole_file(directory / "out.ply", kLong);
  });
  EXPECT_EQ(error.kind(), ErrorKind::output);
  EXPECT_EQ(error.problem(), "cannot write the file: File too large");
  EXPECT_EQ(error.where(), (directory / "out.ply").string());
  EXPECT_EQ(read_bytes(directory / "out.ply"), "old");
  EXPECT_EQ(directory.names(), Names{"out.ply"});
}

TEST(AtomicFile, EveryFormatLeavesTheOldFileWhenItCannotGrow) {
  const TemporaryDirectory directory;
  const Volume volume = vantage::testing::make_hemisphere(Vec3::Zero(), 100, 100, 50);
  for (const std::string name : {"v.ply", "v.obj", "v.stl", "v.glb"}) {
    write_bytes(directory / name, "old");
    const FileSizeLimit limit(20000);
    EXPECT_EQ(error_of([&] { write_volume(volume, directory / name); }).kind(), ErrorKind::output) << name;
    EXPECT_EQ(read_bytes(directory / name), "old") << name;
  }
  EXPECT_EQ(directory.names().size(), 4u);
}

TEST(AtomicFile, AFullDiskLeavesTheOldFile) {
  const TemporaryDirectory directory;
  if (::mount("tmpfs", directory.path().c_str(), "tmpfs", 0, "size=256k") != 0) {
    GTEST_SKIP() << "this user may not mount a small disk";
  }
  write_bytes(directory / "out.ply", "old");
  const Error error = error_of([&] { write_whole_file(directory / "out.ply", kLong); });
  EXPECT_EQ(error.kind(), ErrorKind::output);
  EXPECT_EQ(error.problem(), "cannot write the file: No space left on device");
  EXPECT_EQ(error.fix(), "free some space or write elsewhere; the old file, if any, is as it was");
  EXPECT_EQ(read_bytes(directory / "out.ply"), "old");
  EXPECT_EQ(directory.names(), Names{"out.ply"});
  EXPECT_EQ(::umount(directory.path().c_str()), 0);
}

}  // namespace
}  // namespace vantage::internal::core
