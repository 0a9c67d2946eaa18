// What tells files of one name apart.

#include "formats/disk/file_digest.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/faulty_file_system.h"

namespace spillway::test {
namespace {

FileDigest digest(const std::string& content) {
  FaultyFileSystem files;
  files.files["a"] = content;
  return digest_of(*files.open("a"));
}

TEST(FileDigest, SeesEveryByteOfSmallFilesAndOfBeginningAndEndOfLargeOnes) {
  for (const std::size_t size : {1UL, 375UL, 100000UL, 262144UL, 262145UL, 330000UL, 5000000UL}) {
    const std::string content(size, 'x');
    const FileDigest whole = digest(content);
    EXPECT_EQ(digest(content), whole);
    EXPECT_EQ(whole.size, size);
    EXPECT_NE(digest(content + "x"), whole);
    for (const std::size_t at : {std::size_t{0}, size / 7, size - 1, size - size / 80 - 1}) {
      if (size > 400000 && at > 262143 && at < size - 65536) continue;
      std::string changed = content;
      changed[at] = 'y';
      EXPECT_NE(digest(changed), whole) << size << " bytes, at " << at;
    }
  }
  EXPECT_EQ(digest("").size, 0U);
}

TEST(FileDigest, SeesOtherContentsBetween) {
  const std::string content(5000000, 'x');
  std::string changed = content;
  changed.replace(2000000, 1000000, 1000000, 'y');
  EXPECT_NE(digest(changed), digest(content));
}

}  // namespace
}  // namespace spillway::test
