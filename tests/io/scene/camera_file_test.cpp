// SPDX-License-Identifier: BSD-3-Clause
#include "io/scene/camera_file.hpp"

#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

using scene::ProjectionKind;
using test::expect_bad_input;

CameraFile oblique() {
  CameraFile view;
  view.camera.position = {1.0 / 3, -7e6, 1e-20};
  view.camera.focal_point = {0, 0, 5};
  view.camera.view_up = {0, 0.1, 1};
  view.camera.parallel_scale = 0.1;
  return view;
}

TEST(CameraFile, ReadsBackTheSameDoublesItWrote) {
  const test::TemporaryFolder folder;
  CameraFile orthographic = oblique();
  orthographic.size = scene::ImageSize{640, 480};
  orthographic.camera.clipping_range = {0.1, 1e300};
  CameraFile perspective = oblique();
  perspective.camera.projection = ProjectionKind::perspective;
  perspective.camera.parallel_scale = 1;  // not written: it has no meaning in a perspective view
  perspective.camera.view_angle = 33.3;
  for (const CameraFile& view : {orthographic, perspective}) {
    write_camera(view, folder / "view.json");
    EXPECT_EQ(read_cameras(folder / "view.json"), std::vector{view});
  }
  EXPECT_EQ(folder.names(), std::vector<std::string>{"view.json"});
}

TEST(CameraFile, ReadsPlainText) {
  const CameraFile view = parse_text_camera(
      "# a view\nposition 1 2 3\nfocal_point 0 0 0 # centre\n\nview_up 0 0 1\r\nview_angle 45\n"
      "clipping_range 0.5 10\nsize 640 480\n",
      "view.txt");
  EXPECT_EQ(view.camera.position, glm::dvec3(1, 2, 3));
  EXPECT_EQ(view.camera.view_up, glm::dvec3(0, 0, 1));
  EXPECT_EQ(view.camera.projection, ProjectionKind::perspective);
  EXPECT_EQ(view.camera.view_angle, 45);
  EXPECT_EQ(view.camera.clipping_range, (scene::ClippingRange{0.5, 10}));
  EXPECT_EQ(view.size, (scene::ImageSize{640, 480}));
}

TEST(CameraFile, TheSameViewInThreeFormatsIsTheSame) {
  const std::string text = "position 1 2 3\nfocal_point 0 0 0\nview_up 0 1 0.5\nparallel_scale 2.5\n";
  const std::string json =
      R"({"position": [1, 2, 3], "focal_point": [0, 0, 0], "view_up": [0, 1, 0.5], "parallel_scale": 2.5})";
  const std::string pvcc = R"(<?xml version="1.0"?>
<PVCameraConfiguration description="ParaView camera configuration" version="1.0">
  <Proxy group="views" type="RenderView" id="4135" servers="21">
    <Property name="CameraPosition" id="1" number_of_elements="3">
      <Element index="0" value="1"/><Element index="1" value="2"/><Element index="2" value="3"/>
    </Property>
    <Property name="CameraFocalPoint" id="2" number_of_elements="3">
      <Element index="0" value="0"/><Element index="1" value="0"/><Element index="2" value="0"/>
    </Property>
    <Property name="CameraViewUp" id="3" number_of_elements="3">
      <Element index="0" value="0"/><Element index="1" value="1"/><Element index="2" value="0.5"/>
    </Property>
    <Property name="CenterOfRotation" id="4" number_of_elements="3">
      <Element index="0" value="9"/><Element index="1" value="9"/><Element index="2" value="nonsense"/>
    </Property>
    <Property name="RotationFactor" id="5" number_of_elements="1"><Element index="0" value="1"/></Property>
    <Property name="CameraViewAngle" id="6" number_of_elements="1"><Element index="0" value="30"/></Property>
    <Property name="CameraParallelScale" id="7" number_of_elements="1"><Element index="0" value="2.5"/></Property>
    <Property name="CameraParallelProjection" id="8" number_of_elements="1">
      <Element index="0" value="1"/><Domain name="bool" id="8.bool"/>
    </Property>
  </Proxy>
</PVCameraConfiguration>
)";
  const auto view = parse_cameras(text, "t");
  ASSERT_EQ(view.size(), 1u);
  EXPECT_EQ(parse_cameras(json, "j"), view);
  EXPECT_EQ(parse_cameras("\n  [" + json + "]", "j"), view);
  EXPECT_EQ(parse_cameras(pvcc, "p"), view);

  std::string perspective = pvcc;
  perspective.replace(perspective.find("value=\"1\"/><Domain"), 9, "value=\"0\"");
  const auto seen = parse_cameras(perspective, "p").front().camera;
  EXPECT_EQ(seen.projection, ProjectionKind::perspective);
  EXPECT_EQ(seen.view_angle, 30);
}

TEST(CameraFile, APathIsAListOfViews) {
  const std::string one = R"({"position": [1,2,3], "focal_point": [0,0,0], "view_angle": 30})";
  const std::string two = R"({"position": [1,2,4], "focal_point": [0,0,0], "view_angle": 30, "size": [8, 9.0]})";
  const auto path = parse_json_cameras("[" + one + ", " + two + "]", "path.json");
  ASSERT_EQ(path.size(), 2u);
  EXPECT_EQ(path[1].camera.position.z, 4);
  EXPECT_EQ(path[1].size, (scene::ImageSize{8, 9}));
  expect_bad_input([&] { parse_json_cameras("[" + one + ", {}]", "path.json"); }, {"path.json: view 2: ", "position"});
  expect_bad_input([&] { parse_json_cameras("[]", "path.json"); }, {"empty list"});
}

TEST(CameraFile, RefusesTextWithoutAViewNamingTheLine) {
  const std::string good = "position 0 0 5\nfocal_point 0 0 0\n";
  const struct {
    std::string text;
    std::vector<std::string> parts;
  } cases[] = {
      {"", {"is empty"}},
      {"# nothing\n", {"position is missing"}},
      {"focal_point 0 0 0\nview_angle 30\n", {"position is missing"}},
      {"position 0 0 5\nview_angle 30\n", {"focal_point is missing", "no direction"}},
      {good, {"neither parallel_scale nor view_angle"}},
      {good + "parallel_scale 1\nview_angle 30\n", {"both given"}},
      {good + "view_angle 30\nview_angle 30\n", {"line 4: view_angle is given twice"}},
      {good + "zoom 3\n", {"line 3: 'zoom' is not a setting of a camera", "parallel_scale"}},
      {good + "Position 1 1 1\n", {"line 3: 'Position'"}},
      {good + "view_angle\n", {"line 3: view_angle has 0 numbers; it takes 1"}},
      {good + "view_up 0 1\n", {"line 3: view_up has 2 numbers; it takes 3"}},
      {good + "view_angle 3O\n", {"line 3: '3O' is not a finite number"}},
      {good + "view_angle nan\n", {"line 3: 'nan'"}},
      {good + "view_angle 30\nposition inf 0 0\n", {"line 4: 'inf'"}},
      {good + "view_angle 180\n", {"view_angle is 180"}},
      {good + "parallel_scale 0\n", {"parallel_scale is 0"}},
      {good + "parallel_scale 1\nview_up 0 0 2\n", {"view_up is parallel to the view direction"}},
      {good + "parallel_scale 1\nview_up 0 0 0\n", {"view_up is zero"}},
      {"position 1 1 1\nfocal_point 1 1 1\nview_angle 30\n", {"the camera has no direction"}},
      {good + "parallel_scale 1\nclipping_range 5 5\n", {"clipping_range is 5 to 5"}},
      {good + "parallel_scale 1\nsize 0 100\n", {"line 4: size has a side of 0", "65536"}},
      {good + "parallel_scale 1\nsize 1e9 1e9\n", {"line 4: size has a side of 1"}},
      {good + "parallel_scale 1\nsize 10.5 10\n", {"10.5"}},
      {good + "parallel_scale 1\nsize -1 10\n", {"-1"}},
      {good + "parallel_scale 1\nsize 640x480\n", {"'640x480'"}},
  };
  for (const auto& bad : cases) {
    auto parts = bad.parts;
    parts.insert(parts.end(), {"view.txt: ", "; "});
    if (bad.text.find("view_angle 180") != std::string::npos) parts.emplace_back("below 180 degrees");
    expect_bad_input([&] { parse_cameras(bad.text, "view.txt"); }, parts);
  }
}

TEST(CameraFile, RefusesBrokenJson) {
  const std::string good = R"("position": [0,0,5], "focal_point": [0,0,0], "view_angle": 30)";
  const struct {
    std::string text;
    std::vector<std::string> parts;
  } cases[] = {
      {"{\"position\": [0,0", {"not valid JSON", "line 1"}},
      {"{" + good + ", \"fov\": 3}", {"'fov' is not a setting"}},
      {"{" + good + ", \"view_angle\": 3}", {"'view_angle' is given twice"}},
      {"{" + good + ", \"parallel_scale\": 3}", {"both given"}},
      {"{" + good + ", \"view_up\": [0,1]}", {"view_up has 2 numbers"}},
      {"{" + good + ", \"view_up\": \"y\"}", {"'view_up'", "not a finite number"}},
      {"{" + good + ", \"view_up\": [0,null,1]}", {"'view_up'"}},
      {"{" + good + ", \"view_up\": {\"x\": 1}}", {"'view_up'"}},
      {"{" + good + ", \"size\": [1000000000, 5]}", {"side of 1000000000"}},
      {"{" + good + ", \"size\": [1e300, 5]}", {"side of 1e+300"}},
      {"[3]", {"view 1: is not an object"}},
      {"[" + std::string(99999, '['), {"levels deep"}},
  };
  for (const auto& bad : cases) {
    auto parts = bad.parts;
    parts.insert(parts.end(), {"view.json: ", "; "});
    expect_bad_input([&] { parse_cameras(bad.text, "view.json"); }, parts);
  }
}

TEST(CameraFile, RefusesBrokenPvcc) {
  const auto property = [](const std::string& name, const std::vector<std::string>& values) {
    std::string text = "<Property name=\"" + name + "\">";
    for (std::size_t i = 0; i < values.size(); ++i)
      text += "<Element index=\"" + std::to_string(i) + "\" value=\"" + values[i] + "\"/>";
    return text + "</Property>";
  };
  const auto file = [](const std::string& inside) {
    return "<PVCameraConfiguration>\n" + inside + "</PVCameraConfiguration>";
  };
  const std::string position = property("CameraPosition", {"0", "0", "5"}),
                    focus = property("CameraFocalPoint", {"0", "0", "0"}), angle = property("CameraViewAngle", {"30"});
  EXPECT_EQ(parse_cameras(file(position + focus + angle), "v.pvcc").size(), 1u);
  const struct {
    std::string text;
    std::vector<std::string> parts;
  } cases[] = {
      {"<Other/>", {"line 1: ", "'Other'", "PVCameraConfiguration"}},
      {file(position + focus + angle).substr(0, 80), {"not valid XML"}},
      {file(focus + angle), {"CameraPosition is missing"}},
      {file(position + angle), {"CameraFocalPoint is missing"}},
      {file(position + focus), {"CameraViewAngle is missing"}},
      {file(position + focus + property("CameraParallelProjection", {"1"}) + angle),
       {"CameraParallelScale is missing"}},
      {file(position + position + focus + angle), {"line 2: CameraPosition is given twice"}},
      {file(property("CameraPosition", {"0", "0"}) + focus + angle), {"2 of 3 numbers"}},
      {file(property("CameraPosition", {"0", "0", "x"}) + focus + angle), {"'x'"}},
      {file(property("CameraPosition", {"0", "0", "1", "2"}) + focus + angle), {"index '3'"}},
      {file(property("CameraPosition", {"0", "0", "nan"}) + focus + angle), {"'nan'"}},
      {file(property("CameraPosition", {"0", "0", "0"}) + focus + angle), {"no direction"}},
      {"<!DOCTYPE a [<!ENTITY b \"c\">]><PVCameraConfiguration/>", {"DOCTYPE"}},
  };
  for (const auto& bad : cases) {
    auto parts = bad.parts;
    parts.insert(parts.end(), {"v.pvcc: ", "; "});
    expect_bad_input([&] { parse_cameras(bad.text, "v.pvcc"); }, parts);
  }
}

TEST(CameraFile, RefusesAMissingFileAndADirectory) {
  const test::TemporaryFolder folder;
  expect_bad_input([&] { read_cameras(folder / "none.json"); }, {"none.json: there is no such file"});
  expect_bad_input([&] { read_cameras(folder.path()); }, {"is a directory"});
  expect_bad_input([&] { write_camera(oblique(), folder / "none/view.json"); }, {"none/view.json", "directory"});
}

}  // namespace
}  // namespace tessera::io
