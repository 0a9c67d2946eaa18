#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tests/formats/meshes/mesh_test_helpers.h"

namespace spillway::test {

/// Whatever is done to a file, reading it ends with a mesh or an Failure.
inline void expect_mesh_or_error(FaultyFileSystem& files, const std::string& path) {
  try {
    is_mesh(files, path);
    const Mesh mesh = read_mesh(files, path);
    ASSERT_EQ(mesh.header.vertices, mesh.vertices.size());
    ASSERT_EQ(mesh.corners.size(), mesh.header.simplices * mesh.corners_per_simplex());
    for (const std::uint64_t corner : mesh.corners) ASSERT_LT(corner, mesh.vertices.size());
  } catch (const Failure& error) {
    ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
  }
}

/// Cuts the file at every byte, then changes every byte in several ways, some of them as on a pipe.
inline void break_everywhere(FaultyFileSystem& files, const std::string& broken,
                             const std::string& path) {
  const std::string good = files.files.at(broken);
  for (std::size_t size = 0; size < good.size(); ++size) {
    files.files[broken] = good.substr(0, size);
    files.seekable = size % 2 == 0;
    expect_mesh_or_error(files, path);
  }
  for (std::size_t at = 0; at < good.size(); ++at) {
    for (const int change : {0x01, 0x10, 0xff}) {
      files.files[broken] = good;
      files.files[broken][at] = static_cast<char>(good[at] ^ change);
      files.seekable = change != 0x10;
      expect_mesh_or_error(files, path);
    }
  }
  files.files[broken] = good;
}

}  // namespace spillway::test
