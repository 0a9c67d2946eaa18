#pragma once

#include <memory>
#include <string>

#include "formats/bytes/input_bytes.h"
#include "formats/disk/file_system.h"
#include "formats/meshes/mesh_formats.h"

namespace spillway::formats {

/// A file system in which one input can be looked at before somebody opens it: what the look has
/// read of a pipe is not lost. Everything else is as in the file system beneath.
class ProbedInput final : public FileSystem {
 public:
  /// `files` must outlive it.
  ProbedInput(FileSystem& files, std::string path) : files_(files), path_(std::move(path)) {}

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] FileSystem& beneath() const { return files_; }

  /// Opens the input, unless that is done, to look at its first bytes.
  InputBytes& source();

  /// Whether the input's bytes come only once: standard input, and what exists and is no regular
  /// file, as a named pipe or /dev/fd/N. To be asked before open(). Throws Failure if the input is
  /// there and cannot be opened.
  bool is_pipe();

  /// Closes what source() has opened, if it can be opened again.
  void release();

  /// Gives out the input that source() has opened, the first time.
  std::unique_ptr<InputFile> open(const std::string& path) override;

  std::unique_ptr<OutputFile> create(const std::string& path) override {
    return files_.create(path);
  }
  [[nodiscard]] bool exists(const std::string& path) const override { return files_.exists(path); }

 private:
  FileSystem& files_;
  std::string path_;
  std::unique_ptr<InputBytes> source_;
};

enum class ContentKind {
  kPoints,
  kMesh,        ///< what read_mesh() reads
  kMeshStream,  ///< what open_mesh_stream_reader() reads
};

/// What an input holds, by its name and its first bytes; points if neither tells of a mesh. A pipe
/// holds points or a mesh stream. Throws Failure if it cannot be opened.
ContentKind kind_of_content(ProbedInput& input, MeshFormats formats = mesh_formats());

}  // namespace spillway::formats
