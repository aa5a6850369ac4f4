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

#include "common/atomic_file.h"
#include "support/formats.h"
#include "support/solids.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/volume.h"

namespace vantage::internal::core {
namespace {

using vantage::testing::error_of;
using vantage::testing::expect_error;
using vantage::testing::read_bytes;
using vantage::testing::TemporaryDirectory;
using vantage::testing::write_bytes;
using Names = std::vector<std::string>;

const std::string kLong(3 << 20, 'x');  // larger than the buffer

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
    for (const std::string& name : directory.names()) {  // one more at most, where files cannot be without a name
      EXPECT_TRUE(name == "out.ply" || name == ".out.ply.vantage-0.tmp") << name;
    }
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
  EXPECT_EQ(error.code(), ErrorCode::output_unwritable);
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
  expect_error([&] { AtomicFile file(directory.path()); }, ErrorCode::output_not_a_file, directory.path().string());
  expect_error([&] { AtomicFile file(directory / "new/"); }, ErrorCode::output_not_a_file, "new/");
  expect_error([&] { AtomicFile file(""); }, ErrorCode::output_name_missing);
  EXPECT_TRUE(directory.names().empty());
}

TEST(AtomicFile, SaysThatTheFolderIsMissing) {
  const TemporaryDirectory directory;
  expect_error([&] { AtomicFile file(directory / "none/a.ply"); }, ErrorCode::output_folder_missing, "none/a.ply");
  expect_error([&] { write_whole_file(directory / "no/such/out.ply", "x"); }, ErrorCode::output_folder_missing,
               "out.ply");
  write_bytes(directory / "file", "");
  expect_error([&] { AtomicFile file(directory / "file/a.ply"); }, ErrorCode::output_folder_missing, "file/a.ply");
}

TEST(AtomicFile, RefusesDevicesAndPipes) {
  const TemporaryDirectory directory;
  expect_error([] { write_whole_file("/dev/full", "x"); }, ErrorCode::output_not_a_file, "/dev/full");
  ASSERT_EQ(::mkfifo((directory / "pipe").c_str(), 0600), 0);
  expect_error([&] { write_whole_file(directory / "pipe", "x"); }, ErrorCode::output_not_a_file, "pipe");
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
  expect_error([&] { write_whole_file(directory / "loop", "x"); }, ErrorCode::output_unwritable, "loop");
}

TEST(AtomicFile, RefusesWhatMayNotBeWritten) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const TemporaryDirectory directory;
  write_bytes(directory / "out.ply", "old");
  ASSERT_EQ(::chmod((directory / "out.ply").c_str(), 0444), 0);
  vantage::testing::expect_code([&] { write_whole_file(directory / "out.ply", "new"); }, ErrorCode::output_unwritable,
                                "out.ply");
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
  EXPECT_EQ(error.code(), ErrorCode::output_unwritable);
  EXPECT_EQ(error.where(), (directory / "out.ply").string());
  EXPECT_EQ(read_bytes(directory / "out.ply"), "old");
  EXPECT_EQ(directory.names(), Names{"out.ply"});
}

TEST(AtomicFile, EveryFormatLeavesTheOldFileWhenItCannotGrow) {
  const TemporaryDirectory directory;
  const Volume volume = vantage::testing::make_hemisphere(Vec3::Zero(), 100, 100, 50);
  for (const std::string& name : vantage::testing::in_each_format("v")) {
    write_bytes(directory / name, "old");
    const FileSizeLimit limit(20000);
    expect_error([&] { write_volume(volume, directory / name); }, ErrorCode::output_unwritable, name);
    EXPECT_EQ(read_bytes(directory / name), "old") << name;
  }
  EXPECT_EQ(directory.names().size(), mesh_format_words().size());
}

TEST(AtomicFile, AFullDiskLeavesTheOldFile) {
  const TemporaryDirectory directory;
  if (::mount("tmpfs", directory.path().c_str(), "tmpfs", 0, "size=256k") != 0) {
    GTEST_SKIP() << "this user may not mount a small disk";
  }
  write_bytes(directory / "out.ply", "old");
  // Few users may mount a disk, so the golden file may lack the words.
  const Error error = vantage::testing::expect_code([&] { write_whole_file(directory / "out.ply", kLong); },
                                                    ErrorCode::output_unwritable, "out.ply");
  EXPECT_NE(error.problem().find("No space"), std::string::npos) << error.what();
  EXPECT_NE(error.fix().find("old file"), std::string::npos) << error.what();
  EXPECT_EQ(read_bytes(directory / "out.ply"), "old");
  EXPECT_EQ(directory.names(), Names{"out.ply"});
  EXPECT_EQ(::umount(directory.path().c_str()), 0);
}

}  // namespace
}  // namespace vantage::internal::core
