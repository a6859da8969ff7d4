// SPDX-License-Identifier: BSD-3-Clause
// Defaults for the images of a time series, and the report of `info` on one.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "apps/program.hpp"

namespace tessera::apps::series_defaults_test {
namespace {

using Json = nlohmann::json;
using Names = std::vector<std::string>;
/// Values of a field as a function of a point's x, which is scaled to 0 to 1.
using Values = std::function<double(double)>;

struct Field {
  std::string name;
  Values values;
};

std::string array_text(const char* type, const std::string& name, int components, const std::string& numbers) {
  return fmt::format(R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="ascii">{}</DataArray>)", type,
                     name, components, numbers);
}

/// A row of five unit cubes along x with these fields at its points.
std::string row_of_cubes(const std::vector<Field>& fields) {
  constexpr int cubes = 5;
  std::string points, corners, offsets, types, data;
  std::vector<double> xs;
  for (int i = 0; i <= cubes; ++i)
    for (int k = 0; k < 4; ++k) {
      points += fmt::format("{} {} {} ", i, static_cast<int>(k == 1 || k == 2), k / 2);
      xs.push_back(i / static_cast<double>(cubes));
    }
  for (int c = 0; c < cubes; ++c) {
    for (int k = 0; k < 8; ++k) corners += fmt::format("{} ", 4 * c + k);
    offsets += fmt::format("{} ", 8 * (c + 1));
    types += "12 ";
  }
  for (const Field& field : fields) {
    std::string numbers;
    for (const double x : xs) numbers += fmt::format("{} ", field.values(x));
    data += array_text("Float64", field.name, 1, numbers);
  }
  return fmt::format(
      R"(<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian"><UnstructuredGrid>)"
      R"(<Piece NumberOfPoints="{}" NumberOfCells="{}"><PointData>{}</PointData><Points>{}</Points><Cells>{}{}{}</Cells>)"
      R"(</Piece></UnstructuredGrid></VTKFile>)",
      xs.size(), cubes, data, array_text("Float64", "", 3, points), array_text("Int64", "connectivity", 1, corners),
      array_text("Int64", "offsets", 1, offsets), array_text("UInt8", "types", 1, types));
}

Values times(double factor) {
  return [factor](double x) { return factor * x; };
}

class SeriesDefaults : public ::testing::Test {
 protected:
  /// s_0.vtu, ... and s.pvd, at times 0, 0.25, 0.5 ...
  void write(const std::vector<std::vector<Field>>& steps) {
    std::string list;
    for (std::size_t k = 0; k < steps.size(); ++k) {
      (void)folder.file(fmt::format("s_{}.vtu", k), row_of_cubes(steps[k]));
      list += fmt::format(R"(<DataSet timestep="{}" file="s_{}.vtu"/>)", 0.25 * static_cast<double>(k), k);
    }
    pvd = folder.file("s.pvd", R"(<VTKFile type="Collection"><Collection>)" + list + "</Collection></VTKFile>");
  }

  [[nodiscard]] Names film(const std::string& input, const Names& more = {}) const {
    Names all = {"render", input, "-o", folder / "f_%d.pfm", "--size", "16x16", "--report", folder / "r.json"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  Json report_of(const std::string& input, const Names& more = {}) const {
    const Outcome run = tessera(film(input, more));
    EXPECT_EQ(run.status, 0) << run.err;
    return Json::parse(contents(folder / "r.json"));
  }

  Json info_of(const std::string& input, const Names& more = {}) const {
    Names all = {"info", input, "--json"};
    all.insert(all.end(), more.begin(), more.end());
    const Outcome run = tessera(all);
    EXPECT_EQ(run.status, 0) << run.err;
    return Json::parse(run.out);
  }

  Folder folder;
  std::string pvd;
};

TEST_F(SeriesDefaults, GoByTheStepsThatVary) {
  write({{{"still", times(0)}, {"conc", times(0)}, {"depth", times(3)}},
         {{"still", times(0)}, {"conc", times(0.5)}, {"depth", times(3)}},
         {{"still", times(0)}, {"conc", times(2)}, {"depth", times(3)}},
         {{"still", times(0)}, {"conc", times(1)}, {"depth", times(3)}}});
  for (const std::string& input : {pvd, folder / "s_%d.vtu"}) {
    const Json report = report_of(input, {"--transfer-function", "viridis"});
    EXPECT_EQ(report.at("mesh").at("field").at("name"), "conc") << input;
    EXPECT_EQ(report.at("transfer_function").at("knots").front().at(0), 0);
    EXPECT_EQ(report.at("transfer_function").at("knots").back().at(0), 2);
    const Json by_default = report_of(input);
    EXPECT_GT(by_default.at("transfer_function").at("range").at(1), 1.5);
    const Json info = info_of(input);
    EXPECT_EQ(info.at("field").at("name"), "conc");
    EXPECT_EQ(info.at("time_steps").at("range"), Json({0, 2}));
    EXPECT_EQ(info.at("renders").at("transfer_function"), by_default.at("transfer_function"));
    EXPECT_EQ(info.at("notes"), by_default.at("mesh").at("notes"));
  }
  // A single step uses its own values.
  EXPECT_EQ(info_of(pvd, {"--time-step", "0"}).at("field").at("name"), "depth");
  EXPECT_EQ(info_of(pvd, {"--time-step", "3"}).at("field").at("range").at(1), 1);
}

TEST_F(SeriesDefaults, SpanAllExaminedSteps) {
  const auto shifted = [](double by) { return [by](double x) { return by + x; }; };
  write({{{"p", shifted(0)}}, {{"p", shifted(1)}}, {{"p", shifted(5)}}});
  const Json report = report_of(pvd, {"--transfer-function", "viridis"});
  EXPECT_EQ(report.at("transfer_function").at("knots").front().at(0), 0);
  EXPECT_EQ(report.at("transfer_function").at("knots").back().at(0), 6);
  EXPECT_EQ(report.at("frames").size(), 3u);
}

TEST_F(SeriesDefaults, ExamineFiveStepsAtMostAndWarnOfOthers) {
  std::vector<std::vector<Field>> steps(13, {{"p", times(0)}});
  steps[9] = {{"p", times(1)}};  // of 0, 3, 6, 9 and 12
  steps[8] = {{"p", times(4)}};
  write(steps);
  const Outcome run = tessera(film(pvd));
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.err.find(
                "note: field p and its colours are chosen by time steps 0, 3, 6, 9 and 12 of 0 to 12, where it is from "
                "0 to 1"),
            std::string::npos)
      << run.err;
  EXPECT_NE(run.err.find(
                "the values of all time steps range from 0 to 4, but the colours span 0 to 1; --range 0,4 spans all"),
            std::string::npos)
      << run.err;
}

TEST_F(SeriesDefaults, AreTheSameOnRanks) {
  if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
  write({{{"a", times(0)}, {"b", times(0)}}, {{"a", times(0)}, {"b", times(1)}}, {{"a", times(0)}, {"b", times(4)}}});
  const Json alone = report_of(pvd);
  const Outcome run = mpirun(2, film(pvd));
  ASSERT_EQ(run.status, 0) << run.err;
  const Json together = Json::parse(contents(folder / "r.json"));
  EXPECT_EQ(together.at("mesh").at("field").at("name"), "b");
  EXPECT_EQ(together.at("transfer_function"), alone.at("transfer_function"));
  EXPECT_EQ(together.at("mesh").at("notes"), alone.at("mesh").at("notes"));
}

TEST_F(SeriesDefaults, ReportsAnUnreadableStepWhenItIsReached) {
  write({{{"p", times(1)}}, {{"p", times(1)}}, {{"p", times(1)}}});
  (void)folder.file("s_2.vtu", "<VTKFile type=\"UnstructuredGrid\">");
  const Outcome run = tessera(film(pvd));
  EXPECT_EQ(run.status, 2);
  EXPECT_TRUE(std::filesystem::exists(folder / "f_1.pfm"));
  EXPECT_EQ(tessera({"info", pvd}).status, 0);
}

TEST_F(SeriesDefaults, InfoListsStepsAndTimes) {
  write({{{"p", times(1)}}, {{"p", times(1)}}, {{"p", times(1)}}});
  const Outcome text = tessera({"info", pvd});
  EXPECT_NE(text.out.find("steps     3, at times 0, 0.25, 0.5; the lines below are for step 0 of 0 to 2\n"),
            std::string::npos)
      << text.out;
  EXPECT_EQ(info_of(pvd, {"--time-step", "2"}).at("time_steps"),
            Json({{"count", 3}, {"step", 2}, {"times", {0, 0.25, 0.5}}, {"range", nullptr}}));
  EXPECT_EQ(info_of(folder / "s_%d.vtu").at("time_steps"),
            Json({{"count", 3}, {"step", 0}, {"numbers", {0, 1, 2}}, {"range", {0, 1}}}));
  EXPECT_EQ(report_of(pvd).at("frames").at(2).at("time"), 0.5);
  const Outcome beyond = tessera({"info", pvd, "--time-step", "3"});
  EXPECT_EQ(beyond.status, 2);
  EXPECT_NE(beyond.err.find("there is no time step 3, it has only 3; count from 0"), std::string::npos) << beyond.err;
}

TEST_F(SeriesDefaults, NumberedFilesHaveTheTimesThatTheyState) {
  const auto write_at = [&](int step, const std::string& array) {
    std::string text = row_of_cubes({{"p", times(1)}});
    const std::size_t piece = text.find("<Piece");
    if (!array.empty()) text.insert(piece, "<FieldData>" + array + "</FieldData>");
    (void)folder.file(fmt::format("t_{}.vtu", step), text);
  };
  write_at(7, R"(<DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii"> 0.125 </DataArray>)");
  // The base64 text contains the number of bytes, and then the bytes of 0.5.
  write_at(8, R"(<DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="binary" RangeMin="0.5" )"
              R"(RangeMax="0.5">CAAAAAAAAAAAAOA/</DataArray>)");
  EXPECT_EQ(info_of(folder / "t_%d.vtu").at("time_steps").at("times"), Json({0.125, 0.5}));
  EXPECT_EQ(report_of(folder / "t_%d.vtu").at("frames").at(1).at("time"), 0.5);
  write_at(9, "");  // no time is used if only a part of the series has one
  EXPECT_EQ(info_of(folder / "t_%d.vtu").at("time_steps").at("numbers"), Json({7, 8, 9}));
}

TEST_F(SeriesDefaults, LegacyFilesAndListsOfPiecesHaveTheTimesThatTheyState) {
  const std::string grid =
      "DIMENSIONS 2 2 2\nORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA 8\nSCALARS p float 1\nLOOKUP_TABLE default\n";
  const std::string head = "# vtk DataFile Version 3.0\ntitle\n", dataset = "DATASET STRUCTURED_POINTS\n";
  const auto big_endian = [](auto number) {
    std::string bytes(reinterpret_cast<const char*>(&number), sizeof number);
    return std::string(bytes.rbegin(), bytes.rend());
  };
  std::string ascii =
      head + "ASCII\n" + dataset + "FIELD FieldData 2\nCYCLE 1 1 int\n7\nTIME 1 1 double\n0.125\n" + grid;
  std::string binary = head + "BINARY\n" + dataset + "FIELD FieldData 2\nCYCLE 1 1 int\n" + big_endian(8) +
                       "\nTIME 1 1 double\n" + big_endian(0.5) + "\n" + grid;
  for (int k = 0; k < 8; ++k)
    ascii += fmt::format("{} ", 3 * k * k), binary += big_endian(static_cast<float>(3 * k * k));
  (void)folder.file("l_7.vtk", ascii);
  (void)folder.file("l_8.vtk", binary);
  EXPECT_EQ(info_of(folder / "l_%d.vtk").at("time_steps").at("times"), Json({0.125, 0.5}));
  // Files in a list have the times that they state, too, instead of their indices.
  Names list = film(folder / "l_8.vtk");
  list.insert(list.begin() + 1, folder / "l_7.vtk");
  EXPECT_EQ(tessera(list).status, 0);
  EXPECT_EQ(Json::parse(contents(folder / "r.json")).at("frames").at(1).at("time"), 0.5);

  for (const int step : {1, 2}) {
    std::string text = row_of_cubes({{"p", times(1)}});
    text.insert(text.find("<Piece"), fmt::format(R"(<FieldData><DataArray type="Float64" Name="TimeValue" )"
                                                 R"(format="ascii">{}</DataArray></FieldData>)",
                                                 0.75 * step));
    (void)folder.file(fmt::format("q_{}_0.vtu", step), text);
    (void)folder.file(
        fmt::format("q_{}.pvtu", step),
        fmt::format(R"(<VTKFile type="PUnstructuredGrid" version="1.0" byte_order="LittleEndian">)"
                    R"(<PUnstructuredGrid GhostLevel="0"><PPointData><PDataArray type="Float64" Name="p"/>)"
                    R"(</PPointData><PPoints><PDataArray type="Float64" NumberOfComponents="3"/></PPoints>)"
                    R"(<Piece Source="q_{}_0.vtu"/></PUnstructuredGrid></VTKFile>)",
                    step));
  }
  EXPECT_EQ(info_of(folder / "q_%d.pvtu").at("time_steps").at("times"), Json({0.75, 1.5}));
}

TEST_F(SeriesDefaults, InfoAndRenderShowTheSameOfIdsAlone) {
  int count = 0;
  const std::string file = folder.file("ids.vtu", row_of_cubes({{"GlobalNodeId", [&](double) { return ++count; }}}));
  const Json info = info_of(file);
  EXPECT_EQ(info.at("field").at("name"), "shape (depth)");
  EXPECT_EQ(report_of(file).at("mesh").at("field"), info.at("field"));
}

TEST_F(SeriesDefaults, NeverShowAFieldInSomeStepsAndTheShapeInOthers) {
  write({{}, {{"conc", times(1)}}, {{"conc", times(2)}}});
  for (const Names& command : {film(pvd), Names{"info", pvd}}) {
    const Outcome run = tessera(command);
    EXPECT_EQ(run.status, 2);
    EXPECT_NE(run.err.find("time step 0 has no field 'point:conc', which time step"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("--time-step FIRST:LAST"), std::string::npos) << run.err;
  }
  const Json later = report_of(pvd, {"--time-step", "1:2"});
  EXPECT_EQ(later.at("mesh").at("field").at("name"), "conc");
  write({{}, {}});
  EXPECT_EQ(report_of(pvd).at("mesh").at("field").at("name"), "shape (depth)");
}

TEST_F(SeriesDefaults, AFieldOfAnUnexaminedStepIsNotShownInTheShapesColors) {
  std::vector<std::vector<Field>> steps(13, {{"p", times(0)}});
  steps[8] = {{"p", times(4)}};  // steps 0, 3, 6, 9 and 12 are examined
  write(steps);
  const Outcome run = tessera(film(pvd));
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.err.find("s_8.vtu: time step 8 shows the field 'p'"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("choose the field with --field"), std::string::npos) << run.err;
  const Json chosen = report_of(pvd, {"--field", "p", "--range", "0,4"});
  EXPECT_EQ(chosen.at("frames").size(), 13u);
  EXPECT_EQ(chosen.at("mesh").at("field").at("name"), "p");
}

TEST_F(SeriesDefaults, CountAFieldAsIdsOnlyIfItIsInAllStepsInWhichItVaries) {
  // 24 points: 0, 1, ... in the first step, which is not a quantity, and other values in the next.
  int n = 0;
  const auto counted = [&n](double) { return n++ % 24; };
  write({{{"heat", counted}, {"other", times(0)}}, {{"heat", times(3)}, {"other", times(0)}}});
  EXPECT_EQ(report_of(pvd).at("mesh").at("field").at("name"), "heat");
}

}  // namespace
}  // namespace tessera::apps::series_defaults_test
