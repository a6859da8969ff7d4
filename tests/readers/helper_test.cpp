// SPDX-License-Identifier: BSD-3-Clause
// The helper program, from its caller's side: what it inherits, how its deaths are reported, how it handles damaged
// files.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <thread>
#include <vector>

#include "io/foreign/client/foreign_file.hpp"
#include "io/foreign/client/helper_process.hpp"
#include "support/foam_case.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

using testing::message_of;

std::string proc_text(int process, const char* what) {
  std::ifstream in("/proc/" + std::to_string(process) + "/" + what, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// An image of n^3 points in one piece, with the stated whole extent; ASCII samples 0, 1, 2, ...
std::string image_text(int n, const std::string& whole_extent) {
  const std::string last = std::to_string(n - 1), extent = "0 " + last + " 0 " + last + " 0 " + last;
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"0.1\" byte_order=\"LittleEndian\">\n<ImageData "
      "WholeExtent=\"" +
      whole_extent + "\" Origin=\"0 0 0\" Spacing=\"1 1 1\">\n<Piece Extent=\"" + extent +
      "\">\n<PointData Scalars=\"s\">\n<DataArray type=\"Float32\" Name=\"s\" format=\"ascii\">\n";
  for (int k = 0; k < n * n * n; ++k) text += std::to_string(k % 7) + " ";
  return text + "\n</DataArray>\n</PointData>\n</Piece>\n</ImageData>\n</VTKFile>\n";
}

#ifdef __SANITIZE_ADDRESS__
constexpr bool is_sanitized = true;
#else
constexpr bool is_sanitized = false;
#endif

/// Largest resident memory of children that have been waited for, so far.
long children_kib() {
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  return usage.ru_maxrss;
}

TEST(Helper, InheritsNoFileNoSignalsAndNoRank) {
  ::setenv("OMPI_COMM_WORLD_RANK", "1", 1);
  ::setenv("PMIX_RANK", "1", 1);
  const test::TemporaryFolder folder;
  const auto helper = std::make_shared<HelperProcess>();
  ::unsetenv("OMPI_COMM_WORLD_RANK");
  ::unsetenv("PMIX_RANK");
  // The helper replies, so it has completed its start.
  const ForeignFile opened =
      open_foreign(helper, folder.write("m.vtu", testing::vtu_text(testing::mixed_mesh(2, 1, false))),
                   {{"reader", "vtk_xml"}, {"type", "UnstructuredGrid"}});
  EXPECT_EQ(opened.contents.parts.size(), 1u);
  const std::string environment = proc_text(helper->process(), "environ");
  EXPECT_EQ(environment.find("OMPI_"), std::string::npos);
  EXPECT_EQ(environment.find("PMIX_"), std::string::npos);
  int files = 0;
  for (const auto& file : std::filesystem::directory_iterator("/proc/" + std::to_string(helper->process()) + "/fd")) {
    ++files;
    EXPECT_LE(std::stoi(file.path().filename().string()), 3) << file.path();
  }
  EXPECT_EQ(files, 4);
}

TEST(Helper, ReportsItsCrashInOneLineAboutTheFileEveryTime) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("m.vtu", testing::vtu_text(testing::mixed_mesh(2, 1, false)));
  const struct {
    int signal;
    const char* words;
  } deaths[] = {
      {SIGILL, "crashed"}, {SIGABRT, "crashed"}, {SIGXCPU, "takes much longer"}, {SIGKILL, "killed from outside"}};
  for (const auto& death : deaths) {
    const auto helper = std::make_shared<HelperProcess>();
    ForeignFile opened = open_foreign(helper, file, {{"reader", "vtk_xml"}, {"type", "UnstructuredGrid"}});
    ASSERT_EQ(::kill(helper->process(), death.signal), 0);
    for (int again = 0; again < 2; ++again) {
      std::vector<std::string> notes;
      const std::string message = message_of([&] { blocks_of(opened, notes); });
      EXPECT_TRUE(message.starts_with(file.string() + ": ")) << message;
      EXPECT_NE(message.find(death.words), std::string::npos) << message;
      EXPECT_NE(message.find("; "), std::string::npos) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
    EXPECT_EQ(helper->process(), -1) << "its process is left unreaped";
  }
}

TEST(Helper, IsEndedWhenItWaitsForAPipe) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  const auto cube = folder / "case", boundary = cube / "constant/polyMesh/boundary";
  testing::write_foam(cube, testing::Cubes(1), [](int) { return true; });
  testing::write_control(cube);
  std::string text = test::contents(boundary);
  text.insert(text.find('}') + 1, "\n#include \"../../../pipe\"\n");  // VTK's reader opens it
  std::ofstream(boundary) << text;
  HelperTask task;
  task.patience = std::chrono::milliseconds(200);
  const auto helper = std::make_shared<HelperProcess>(task);
  const test::Fault fault = test::fault_of([&] { open_foreign(helper, cube, {{"reader", "openfoam"}}); });
  EXPECT_EQ(fault.code, scene::ErrorCode::bad_input) << fault.message;
  EXPECT_NE(fault.message.find("waits for data that do not arrive"), std::string::npos) << fault.message;
  EXPECT_EQ(helper->process(), -1) << "its process is left";
}

TEST(Helper, ReportsProgress) {
  const test::TemporaryFolder folder;
  std::string text = testing::vtu_text(testing::mixed_mesh(60, 1, false));
  const std::string element = "<UnstructuredGrid";
  text.insert(text.find(element + ">") + element.size(), " TimeValues=\"0\"");  // only VTK's reader supports them
  const auto file = folder.write("m.vtu", text);
  std::vector<ReadProgress> reported;
  ReadOptions options;
  options.progress = [&](const ReadProgress& progress) { reported.push_back(progress); };
  const cells::MeshFile mesh = read_mesh(file, options);
  EXPECT_GT(mesh.mesh.positions.size(), 100000u);
  std::size_t reading = 0;
  for (std::size_t k = 0; k < reported.size(); ++k) {
    EXPECT_GE(reported[k].done, 0);
    EXPECT_LE(reported[k].done, 1);
    if (reported[k].stage == ReadProgress::Stage::reading) ++reading;
    if (k == 0 || reported[k].stage != reported[k - 1].stage) continue;
    EXPECT_GE(reported[k].done, reported[k - 1].done);
  }
  EXPECT_GT(reading, 0u);
  ASSERT_FALSE(reported.empty());
  EXPECT_EQ(reported.back().stage, ReadProgress::Stage::copying);
  EXPECT_EQ(reported.back().done, 1);
}

TEST(Helper, StreamsAnArrayInPartsAndGoesOnAfterAnExceptionInOne) {
  const test::TemporaryFolder folder;
  constexpr int n = 110;  // n^3 floats fill more than two slots of the window
  const auto helper = std::make_shared<HelperProcess>();
  const ForeignFile opened = open_foreign(helper, folder.write("v.vti", image_text(n, "0 109 0 109 0 109")),
                                          {{"reader", "vtk_xml"}, {"type", "ImageData"}});
  const ForeignArray& samples = opened.contents.parts.at(0).point_fields.at(0);
  int parts = 0;
  EXPECT_THROW(helper->stream(samples, "v.vti",
                              [&](std::span<const std::byte>) {
                                if (++parts == 2) throw std::runtime_error("the caller's own");
                              }),
               std::runtime_error);
  std::vector<float> got;
  helper->stream(samples, "v.vti", [&](std::span<const std::byte> tuples) {
    const auto* const first = reinterpret_cast<const float*>(tuples.data());
    got.insert(got.end(), first, first + tuples.size() / sizeof(float));
  });
  ASSERT_EQ(got.size(), std::size_t{n} * n * n);
  for (std::size_t k = 0; k < got.size(); ++k) ASSERT_EQ(got[k], static_cast<float>(k % 7)) << k;
  EXPECT_THROW(helper->stream(samples, "v.vti", [](std::span<const std::byte>) {}), scene::Error)
      << "it still has what it has given away";
}

TEST(Helper, EndsWithItsObject) {
  int process = 0;
  {
    const HelperProcess helper;
    process = helper.process();
    EXPECT_EQ(::kill(process, 0), 0);
  }
  EXPECT_EQ(::waitpid(process, nullptr, WNOHANG), -1) << "it is still there, or a zombie";
}

TEST(Helper, FilesAreReadByManyThreadsAtOnce) {
  const test::TemporaryFolder folder;
  const auto mesh = folder.write("m.vtu", testing::vtu_text(testing::mixed_mesh(3, 5, false)));
  const auto image = folder.write("v.vti", image_text(4, "0 3 0 3 0 3"));
  const std::size_t tets = read_mesh(mesh).mesh.tets.size();
  std::vector<std::jthread> threads;
  for (int t = 0; t < 8; ++t)
    threads.emplace_back([&, t] {
      for (int n = 0; n < 3; ++n) {
        if (t % 2 == 0)
          EXPECT_EQ(read_mesh(mesh).mesh.tets.size(), tets);
        else
          EXPECT_EQ(open_volume(image).range.high, 6);
      }
    });
}

TEST(Helper, ADescriptionIsReturnedUnchanged) {
  ForeignContents contents;
  contents.format = "f\xff";  // names need not be UTF-8
  contents.notes = {"one", "two"};
  ForeignPart part;
  part.kind = ForeignPart::Kind::image;
  part.name = "block";
  part.extent = {-1, 2, 3, 4, 5, 6};
  part.origin = {0.1, -1e300, 5e-324};
  part.spacing = {1, 2, 3};
  part.direction = {1, 0, 0, 0, 0, -1, 0, 1, 0};
  part.point_fields.push_back({.number = 7,
                               .name = "a",
                               .type = NumberType::int64,
                               .components = 3,
                               .tuples = 1ull << 33,
                               .active = true,
                               .tally = {.low = -0.3, .high = 4, .not_finite = 9, .any_finite = true}});
  contents.parts.push_back(part);
  const std::vector<std::uint8_t> bytes = bytes_of(contents);
  const ForeignContents back = contents_of(bytes);
  EXPECT_EQ(back.format, contents.format);
  EXPECT_EQ(back.notes, contents.notes);
  ASSERT_EQ(back.parts.size(), 1u);
  const ForeignPart& got = back.parts.front();
  EXPECT_EQ(got.kind, part.kind);
  EXPECT_EQ(got.name, part.name);
  EXPECT_EQ(got.extent, part.extent);
  EXPECT_EQ(got.origin, part.origin);
  EXPECT_EQ(got.direction, part.direction);
  EXPECT_FALSE(got.points);
  ASSERT_EQ(got.point_fields.size(), 1u);
  EXPECT_EQ(got.point_fields[0].bytes(), 3 * 8 * (1ull << 33));
  EXPECT_EQ(got.point_fields[0].tally.low, -0.3);
  EXPECT_EQ(got.point_fields[0].tally.not_finite, 9u);
  // Truncated contents are refused, at whichever byte they end.
  for (std::size_t cut = 0; cut < bytes.size(); ++cut)
    EXPECT_ANY_THROW(contents_of(std::span(bytes).first(cut))) << cut;
}

TEST(Helper, RefusesAWholeLargerThanItsPiecesBeforeAllocating) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(open_volume(folder.write("right.vti", image_text(4, "0 3 0 3 0 3"))).range.high, 6);
  for (const char* extent : {"0 4 0 3 0 3", "-1 3 0 3 0 3", "0 999999 0 3 0 3", "0 999 0 999 0 999"}) {
    const auto file = folder.write("v.vti", image_text(4, extent));
    const std::string message = message_of([&] { open_volume(file); });
    EXPECT_NE(message.find("its pieces have only 27 of its "), std::string::npos) << message;
    EXPECT_NE(message.find("0 3 0 3 0 3"), std::string::npos) << "what is there: " << message;
  }
}

TEST(Helper, ASmallFileWithLargeCountsUsesLittleMemory) {
  const test::TemporaryFolder folder;
  std::string text = testing::vtu_text(testing::mixed_mesh(2, 1, false));
  const std::size_t at = text.find("NumberOfPoints=\"") + 16;
  text.replace(at, text.find('"', at) - at, "3999999999");
  const auto file = folder.write("m.vtu", text);
  EXPECT_NE(message_of([&] { read_mesh(file); }), "");
  // Sanitizers use unlimited address space, and memory of their own.
  if (!is_sanitized) {
    EXPECT_LT(children_kib(), 600 << 10);
  }
}

TEST(Helper, CountsMayHaveASign) {
  const test::TemporaryFolder folder;
  const std::string text = testing::vtu_text(testing::mixed_mesh(2, 1, false));
  std::string with_sign = text;
  const std::size_t at = with_sign.find("NumberOfPoints=\"") + 16;
  with_sign.insert(at, "+");
  EXPECT_EQ(read_mesh(folder.write("s.vtu", with_sign)).mesh.tets, read_mesh(folder.write("m.vtu", text)).mesh.tets);
}

}  // namespace
}  // namespace tessera::io
