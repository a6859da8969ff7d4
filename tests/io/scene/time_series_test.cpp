// SPDX-License-Identifier: BSD-3-Clause
#include "io/scene/time_series.hpp"

#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

std::vector<std::string> names(const std::vector<TimeStep>& steps) {
  std::vector<std::string> all;
  for (const TimeStep& step : steps)
    for (const auto& file : step.files) all.push_back(file.filename());
  return all;
}

std::vector<double> times(const std::vector<TimeStep>& steps) {
  std::vector<double> all;
  for (const TimeStep& step : steps) all.push_back(step.time);
  return all;
}

using Names = std::vector<std::string>;
using Times = std::vector<double>;

TEST(TimeSeries, APatternListsExistingFilesByNumber) {
  const test::TemporaryFolder folder;
  for (const char* name : {"m_0010.vtu", "m_0002.vtu", "m_12345.vtu", "m_2.vtu", "m_0003.vtk", "m_00011.vtu", "m_.vtu",
                           "m_-001.vtu", "n_0001.vtu", "m_0001.vtu.old"})
    folder.write(name, "x");
  const auto steps = read_time_series(folder / "m_%04d.vtu");
  EXPECT_EQ(names(steps), (Names{"m_0002.vtu", "m_0010.vtu", "m_12345.vtu"}));
  EXPECT_EQ(times(steps), (Times{2, 10, 12345}));
  EXPECT_EQ(names(read_time_series(folder / "m_%d.vtu")), (Names{"m_2.vtu", "m_12345.vtu"}));
  EXPECT_EQ(steps[0].files[0], folder / "m_0002.vtu");
  test::expect_bad_input([&] { read_time_series(folder / "k_%03d.vtu"); }, {"k_%03d.vtu: no file", "like k_001.vtu"});
  test::expect_bad_input([&] { read_time_series(folder / "none" / "k_%03d.vtu"); }, {"cannot be listed"});
}

TEST(TimeSeries, RecognizesSeriesByTheirNames) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(is_time_series("a/m_%04d.vtu"));
  EXPECT_TRUE(is_time_series("m%d.vtu"));
  EXPECT_TRUE(is_time_series("film.PVD"));
  for (const char* name : {"m.vtu", "100%.vtu", "m_%s.vtu", "m_%0d.vtu", "%4d.vtu", "a%d/m.vtu"})
    EXPECT_FALSE(is_time_series(name)) << name;
  EXPECT_FALSE(is_time_series(folder.write("real_%d.vtu", "x")));  // a file with exactly this name
}

TEST(TimeSeries, AFileSeriesGivesTimesInOrder) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("a.vtk.series",
                                 R"({"file-series-version": "1.0", "files": [
      {"name": "b.vtk", "time": 2.5}, {"name": "sub/a.vtk", "time": -1}, {"name": "/elsewhere/c.vtk", "time": 3e1},
      {"name": "again.vtk", "time": 2.5}]})");
  EXPECT_TRUE(is_time_series(file));
  const auto steps = read_time_series(file);
  EXPECT_EQ(names(steps), (Names{"a.vtk", "b.vtk", "again.vtk", "c.vtk"}));
  EXPECT_EQ(times(steps), (Times{-1, 2.5, 2.5, 30}));
  EXPECT_EQ(steps[0].files[0], folder / "sub/a.vtk");
  EXPECT_EQ(steps[3].files[0], "/elsewhere/c.vtk");
  EXPECT_EQ(times(read_time_series(folder.write("b.series", R"({"files": [{"name": "a"}, {"name": "b"}]})"))),
            (Times{0, 1}));
  const auto refuse = [&](const std::string& text, const std::vector<std::string>& parts) {
    test::expect_bad_input([&] { read_time_series(folder.write("c.series", text)); }, parts);
  };
  refuse("{\"files\": [", {"c.series", "line 1", "not valid JSON"});
  refuse("[]", {"no list \"files\""});
  refuse("{\"files\": []}", {"lists no file"});
  refuse("{\"files\": [{\"name\": \"a\"}, {\"time\": 1}]}", {"entry 1", "\"name\""});
  refuse("{\"files\": [{\"name\": \"a\", \"time\": \"1\"}]}", {"entry 0", "\"time\""});
}

TEST(TimeSeries, APvdGivesTimesAndParts) {
  const test::TemporaryFolder folder;
  const auto file =
      folder.write("film.pvd",
                   "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n"
                   "<!-- <DataSet timestep=\"9\" file=\"no.vtu\"/> -->\n"
                   "<DataSet timestep=\"0.5\" group=\"\" part=\"1\" file=\"b1.vtu\"/>\n"
                   "<DataSet timestep=\"0.5\" group=\"\" part=\"0\" file=\"b0.vtu\"/>\n"
                   "<DataSet timestep=\"-1e-3\" part=\"0\" file=\"sub/a&amp;b.vtu\"/>\n"
                   "<DataSet timestep=\"2\" file=\"/elsewhere/c.vtu\"/>\n</Collection></VTKFile>\n");
  const auto steps = read_time_series(file);
  EXPECT_EQ(times(steps), (Times{-1e-3, 0.5, 2}));
  ASSERT_EQ(steps.size(), 3u);
  EXPECT_EQ(steps[0].files, (std::vector<std::filesystem::path>{folder / "sub/a&b.vtu"}));
  EXPECT_EQ(names({steps[1]}), (Names{"b0.vtu", "b1.vtu"}));
  EXPECT_EQ(steps[2].files[0], "/elsewhere/c.vtu");
}

TEST(TimeSeries, WithoutTimesAllPartsAreOneStep) {
  const test::TemporaryFolder folder;
  const auto steps = read_time_series(folder.write(
      "m.pvd",
      "<VTKFile type='Collection'><Collection><DataSet file='a.vtu'/><DataSet file='b.vtu'/></Collection></VTKFile>"));
  ASSERT_EQ(steps.size(), 1u);
  EXPECT_EQ(names(steps), (Names{"a.vtu", "b.vtu"}));
}

TEST(TimeSeries, ReportsMalformedPvdsInOneLine) {
  const test::TemporaryFolder folder;
  const auto refused = [&](const std::string& text, const std::string& part) {
    const auto file = folder.write("bad.pvd", text);
    test::expect_bad_input([&] { read_time_series(file); }, {file.string() + ": ", part});
  };
  const std::string head = "<VTKFile type=\"Collection\"><Collection>", tail = "</Collection></VTKFile>";
  refused("", "empty");
  refused("Dear reader,\n", "line 1");
  refused("<html></html>", "begins with <html>");
  refused("<VTKFile type=\"UnstructuredGrid\"></VTKFile>", "not <VTKFile type=\"Collection\">");
  refused(head + tail, "lists no DataSet");
  refused(head + "<DataSet timestep=\"0\" file=\"a.vtu\"/>", "line 1");
  refused(head + "<DataSet timestep=\"zero\" file=\"a.vtu\"/>" + tail, "'zero'");
  refused(head + "<DataSet timestep=\"nan\" file=\"a.vtu\"/>" + tail, "not a finite number");
  refused(head + "<DataSet timestep=\"0\" part=\"x\" file=\"a.vtu\"/>" + tail, "the part 'x'");
  refused(head + "<DataSet timestep=\"0\"/>" + tail, "DataSet 0 names no file");
  refused("<!DOCTYPE a [<!ENTITY b \"bbbbbbbbbbbbbbbbbbbb\"><!ENTITY c \"&b;&b;&b;\">]>" + head + "&c;</x>", "line 1");
  test::expect_bad_input([&] { read_time_series(folder / "none.pvd"); }, {"there is no such file"});
  const auto huge = folder.write("huge.pvd", head);
  std::filesystem::resize_file(huge, std::uintmax_t{1} << 33);  // sparse: it takes no space
  test::expect_bad_input([&] { read_time_series(huge); }, {"huge.pvd: "});
}

}  // namespace
}  // namespace tessera::io
