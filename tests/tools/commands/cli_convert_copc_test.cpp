// COPC from the command: by name and by format, through pipes, out of core, and read by others.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/tools/command_runner.h"

namespace spillway::test {
namespace {

using ::testing::HasSubstr;

/// A script that proves that the points of a file are those of another one.
std::string same_points(const std::string& a, const std::string& b) {
  return fmt::format(
      "spillway convert -q {0} -o {0}.txt && spillway convert -q {1} -o {1}.txt\n"
      "sort {0}.txt > {0}.sorted && sort {1}.txt > {1}.sorted && cmp {0}.sorted {1}.sorted\n",
      a, b);
}

TEST(ConvertCopc, IsChosenByNameAndByFormat) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 3000 -o in.las\n"
      "spillway convert -q in.las -o name.copc.laz\n"
      "spillway convert -q in.las -o format.laz --output-format copc\n"
      "spillway convert -q in.las -o upper.COPC.LAZ\n"
      "spillway generate -q terrain -n 3000 -o generated.copc.laz\n"
      "spillway generate -q terrain -n 3000 --grid 2x2 --overlap 0 -o 'grid_#.copc.laz'");
  EXPECT_EQ(work.info("name.copc.laz")["format"], "copc");
  EXPECT_EQ(work.info("name.copc.laz")["point_format"], 6);
  for (const char* const same : {"format.laz", "upper.COPC.LAZ", "generated.copc.laz"}) {
    EXPECT_EQ(work.read(same), work.read("name.copc.laz")) << same;
  }
  work.succeed(same_points("in.las", "name.copc.laz"));
  work.succeed("spillway convert -q 'grid_*.copc.laz' -o grid.las\n" +
               same_points("in.las", "grid.las"));
}

TEST(ConvertCopc, APipeGivesTheSameBytes) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 120000 -o in.las\n"
      "spillway convert -q in.las -o file.copc.laz\n"
      "cat in.las | spillway convert -q - --output-format copc -o - | cat > pipe.laz\n"
      "cmp file.copc.laz pipe.laz\n"
      "cat pipe.laz | spillway convert -q - -o back.las\n" +
      same_points("in.las", "back.las"));
}

TEST(ConvertCopc, LittleMemoryGivesTheSamePoints) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 600000 -o in.las\n"
      "spillway convert -q in.las -o much.copc.laz --memory 1G\n"
      "mkdir scratch\n"
      "spillway convert -q in.las -o little.copc.laz --memory 32M --scratch-folder scratch\n"
      "rmdir scratch\n"  // nothing is left there
      + same_points("much.copc.laz", "little.copc.laz"));
  EXPECT_EQ(work.info("much.copc.laz")["cells"], work.info("little.copc.laz")["cells"]);
}

TEST(ConvertCopc, ALimitOfScratchFilesLeavesNothing) {
  const Workspace work;
  work.succeed("spillway generate -q terrain -n 600000 -o in.las");
  const Result run = work.run(
      "spillway convert -q in.las -o out.copc.laz --memory 32M --max-tmp 5M --scratch-folder .");
  EXPECT_NE(run.exit_code, 0);
  EXPECT_THAT(run.err, HasSubstr("temporary files would take more"));
  EXPECT_EQ(work.names(), (std::vector<std::string>{"in.las"}));
}

TEST(ConvertCopc, NodesOfABoxAreReadAlone) {
  const Workspace work;
  work.succeed(
      "spillway generate -q terrain -n 400000 -o in.las\n"
      "spillway convert -q in.las -o all.copc.laz\n"
      "box=500100,4100100,500150,4100140\n"
      "spillway convert -q in.las -o a.las --bounds $box\n"
      "spillway convert -q all.copc.laz -o b.las --bounds $box\n" +
      same_points("a.las", "b.las"));
  EXPECT_GT(work.info("b.las")["points"], 1000);
}

/// Prints the points, one a line as integers of hundredths, which lie in their nodes.
constexpr const char* kReadByNode = R"(
const { Copc } = require('copc');
(async () => {
  const file = process.argv[2];
  const copc = await Copc.create(file);
  const nodes = {};
  const pages = [copc.info.rootHierarchyPage];
  while (pages.length > 0) {
    const page = await Copc.loadHierarchyPage(file, pages.pop());
    Object.assign(nodes, page.nodes);
    pages.push(...Object.values(page.pages));
  }
  const lines = [];
  for (const [key, node] of Object.entries(nodes)) {
    if (node.pointCount === 0) continue;
    const view = await Copc.loadPointDataView(file, copc, node);
    const get = ['X', 'Y', 'Z'].map((axis) => view.getter(axis));
    const [level, ...cell] = key.split('-').map(Number);
    const side = (copc.info.cube[3] - copc.info.cube[0]) / 2 ** level;
    for (let i = 0; i < view.pointCount; ++i) {
      const point = get.map((one) => one(i));
      point.forEach((value, axis) => {
        const low = copc.info.cube[axis] + cell[axis] * side;
        if (value < low || value > low + side) throw new Failure(`${key} has ${point}`);
      });
      lines.push(point.map((value) => value.toFixed(2)).join(' '));
    }
  }
  if (lines.length !== copc.header.pointCount) throw new Failure('points are missing');
  console.log(lines.join('\n'));
})().catch((error) => { console.error(error); process.exit(1); });
)";

TEST(ConvertCopc, TheNpmPackageCopcReadsAllPointsInTheirNodes) {
  const Workspace work;
  if (work.run("node -e \"require('copc')\"").exit_code != 0) {
    GTEST_SKIP() << "node, or its package copc, is not there: npm install copc laz-perf, and "
                    "NODE_PATH";
  }
  work.write("read.cjs", kReadByNode);
  work.succeed(
      "spillway generate -q terrain -n 250000 -o in.las\n"
      "spillway convert -q in.las -o in.copc.laz\n"
      "node read.cjs in.copc.laz > by_node.txt\n"
      "spillway convert -q in.las -o in.txt\n"
      "awk '{ printf \"%.2f %.2f %.2f\\n\", $1, $2, $3 }' by_node.txt | sort > a.sorted\n"
      "grep -v '^[#a-z\"]' in.txt | tr ',;\\t' '   ' |"
      " awk '{ printf \"%.2f %.2f %.2f\\n\", $1, $2, $3 }' | sort > b.sorted\n"
      "cmp a.sorted b.sorted");
}

TEST(ConvertCopc, TheNpmPackageCopcReadsAFileWithoutPoints) {
  const Workspace work;
  if (work.run("node -e \"require('copc')\"").exit_code != 0) {
    GTEST_SKIP() << "node, or its package copc, is not there";
  }
  work.write("read.cjs", kReadByNode);
  work.succeed(
      "spillway generate -q terrain -n 9 -o in.las\n"
      "spillway convert -q in.las -o none.copc.laz --bounds 0,0,1,1\n"
      "node read.cjs none.copc.laz");
}

}  // namespace
}  // namespace spillway::test
