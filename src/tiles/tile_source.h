// Where the files of a tileset come from.
#pragma once

#include <filesystem>
#include <string>

#include "common/shown_address.h"
#include "core/progress_reporter.h"
#include "vantage/error.h"

namespace vantage::internal::tiles {

/// No file of the source can be read any more: a server has ended the session.
class SourceClosed : public Error {
 public:
  explicit SourceClosed(const Error& error) : Error(error) {}
};

/// Files by their address: a path from the tileset's folder, or a URL.
class TileSource {
 public:
  TileSource() = default;
  TileSource(const TileSource&) = delete;
  TileSource& operator=(const TileSource&) = delete;
  virtual ~TileSource() = default;

  /// The address of the tileset itself.
  virtual std::string root() const = 0;
  /// What a file means that names another one by a URI (RFC 3986, section 5). Throws Error(input) for one that may not
  /// be named there.
  virtual std::string resolve(const std::string& base, const std::string& uri) const = 0;
  /// The content of a file, decompressed where it is compressed with gzip. Throws Error(input).
  virtual std::string read(const std::string& address, const core::ProgressReporter& progress) = 0;
  /// What people call it, in errors.
  virtual std::string shown(const std::string& address) const = 0;
  /// The same in ids of objects: short, and without keys.
  virtual std::string name(const std::string& address) const { return without_secrets(address, true); }
};

/// Files of the folder that holds `tileset`, and of folders below it, links followed.
class FolderSource final : public TileSource {
 public:
  explicit FolderSource(std::filesystem::path tileset);

  std::string root() const override { return tileset_.filename().string(); }
  std::string resolve(const std::string& base, const std::string& uri) const override;
  std::string read(const std::string& address, const core::ProgressReporter& progress) override;
  std::string shown(const std::string& address) const override { return (folder_ / address).string(); }

 private:
  std::filesystem::path tileset_, folder_;
};

}  // namespace vantage::internal::tiles
