// SPDX-License-Identifier: BSD-3-Clause
// Large .vti and .vtr of one array, read without VTK, give the same result as VTK.
#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "io/volume/plain_vtk_grid.hpp"
#include "io/volume/volume_formats.hpp"
#include "support/read_files.hpp"
#include "support/some_cases.hpp"
#include "support/streamed_fixture.hpp"
#include "support/volume_bytes.hpp"
#include "support/volume_checks.hpp"
#include "support/vtk_grid_files.hpp"
#include "support/vtk_or_skip.hpp"

namespace tessera::io {
namespace {

using test::all_samples;
using test::axes_of;
using test::AxesCase;
using test::noise;
using test::samples;
using test::vtk_file;
using test::VtkCase;

class StreamedVtk : public test::StreamedVolumes {};

VtkCase with_axes(VtkCase file, AxesCase axes) {
  file.axes = std::move(axes);
  return file;
}

TEST_F(StreamedVtk, MatchVtksOwnReader) {
  TESSERA_VTK_OR_SKIP();
  // appended, base64, compressed, wide numbers, big endian
  const VtkCase cases[] = {{true, false, false, false, false},
                           {true, false, false, true, true},
                           {true, false, true, false, false},
                           {true, false, true, true, true, "Float32"},
                           {true, true, false, true, false, "Int8"},
                           {true, true, true, false, false, "Float64"},
                           {false, true, false, false, false, "UInt8"},
                           {false, true, false, true, true, "Int32"},
                           {false, true, true, true, false},
                           {false, true, true, false, false, "Int16", 3},
                           {true, false, false, false, false, "UInt8", 2, true},
                           {false, true, true, false, false, "UInt8", 1, true}};
  test::SomeCases some(3);
  for (std::size_t k = 0; k < std::size(cases); ++k) {
    if (!some.next()) continue;
    const VtkCase& c = cases[k];
    const std::size_t each = c.type.back() == '8' ? 1 : c.type.ends_with("16") ? 2 : c.type.ends_with("32") ? 4 : 8;
    const auto file = folder.write(std::to_string(k) + ".vti",
                                   vtk_file(c, noise(samples * each * static_cast<std::size_t>(c.components))));
    EXPECT_TRUE(read_plain_vtk_grid(file, 0)) << k;
    // Raw arrays need not be unpacked.
    EXPECT_EQ(is_the_same_streamed(file), c.base64 || c.compressed) << k;
    if (c.components > 1) is_the_same_streamed(file, "rho:1");
  }
}

TEST_F(StreamedVtk, HaveTheCoordinatesOfVtksOwnReader) {
  TESSERA_VTK_OR_SKIP();
  const AxesCase uneven = axes_of("Float64", 1e-3), even = axes_of("Float64", 0);
  const auto as_text = [](AxesCase axes) {
    axes.text = true;
    return axes;
  };
  const auto before = [](AxesCase axes) {
    axes.first = true;
    return axes;
  };
  struct Case {
    VtkCase file;
    bool rectilinear;
  };
  const auto with = [](VtkCase file, AxesCase axes, bool rectilinear) {
    return Case{with_axes(std::move(file), std::move(axes)), rectilinear};
  };
  const VtkCase raw{true, false, false, true, false, "UInt8"}, big{true, false, false, false, true, "UInt8"},
      zlib{true, false, true, true, true, "UInt8"}, text{true, true, false, false, false, "UInt8"},
      zlib_text{true, true, true, false, false, "UInt8"}, inside{false, true, false, true, true, "UInt8"},
      zlib_inside{false, true, true, false, false, "UInt8"}, cells{true, false, true, true, false, "UInt8", 1, true},
      cells_inside{false, true, true, true, false, "UInt8", 1, true};
  const Case cases[] = {with(raw, uneven, true),
                        with(raw, even, false),
                        with(raw, axes_of("Float32", 0, {true, false, false}), false),
                        with(raw, as_text(axes_of("Float32", 1e-3)), true),
                        with(raw, as_text(axes_of("Float32", 0, {false, true, true})), false),
                        with(raw, as_text(axes_of("Int32", 0)), false),
                        with(big, axes_of("Float32", 1e-3, {true, true, true}), true),
                        with(big, axes_of("Int32", 0.01), true),
                        with(zlib, axes_of("Float64", 1e-3, {true, false, true}), true),
                        with(zlib, axes_of("Int64", 0.01, {false, true, false}), true),
                        with(text, axes_of("Float32", 1e-3), true),
                        with(text, before(even), false),
                        with(zlib_text, uneven, true),
                        with(zlib_text, as_text(axes_of("Int64", 0.01)), true),
                        with(inside, uneven, true),
                        with(inside, before(axes_of("Float64", 0, {false, false, true})), false),
                        with(zlib_inside, axes_of("Float32", 1e-3, {false, true, false}), true),
                        with(zlib_inside, before(as_text(uneven)), true),
                        with(zlib_inside, as_text(uneven), true),
                        with(cells, axes_of("Float64", 1e-3, {}, 1), true),
                        with(cells_inside, axes_of("Float32", 0, {false, true, false}, 1), false)};
  for (std::size_t k = 0; k < std::size(cases); ++k) {
    const VtkCase& c = cases[k].file;
    const auto file = folder.write(std::to_string(k) + ".vtr", vtk_file(c, noise(samples)));
    const auto plain = read_plain_vtk_grid(file, 0);
    ASSERT_TRUE(plain) << k;
    EXPECT_EQ(plain->grid.geometry.rectilinear(), cases[k].rectilinear) << k;
    EXPECT_EQ(is_the_same_streamed(file), c.base64 || c.compressed) << k;
  }
  EXPECT_TRUE(scratch.names().empty());
}

TEST_F(StreamedVtk, WithUnusualCoordinatesAreLeftToVtk) {
  VtkCase c{true, false, false, true, false, "UInt8"};
  const std::string bytes = noise(samples);
  const auto is_plain = [&](const std::string& text) {
    return read_plain_vtk_grid(folder.write("v.vtr", text), 0).has_value();
  };
  const auto with = [&](const std::string& old, const std::string& changed) {
    std::string text = vtk_file(c, bytes);
    const std::size_t at = text.find(old, text.find("<Coordinates>"));
    EXPECT_NE(at, std::string::npos) << old;
    return text.replace(at, old.size(), changed);
  };
  c.axes = axes_of("Float64", 1e-3);
  EXPECT_TRUE(is_plain(vtk_file(c, bytes)));
  EXPECT_FALSE(is_plain(with("<DataArray", "<Array><DataArray/></Array><DataArray")));  // four
  EXPECT_FALSE(is_plain(with("<Coordinates>", "<Axes>")));
  EXPECT_FALSE(is_plain(with("<Coordinates>", "<Coordinates/><Coordinates>")));
  EXPECT_FALSE(is_plain(with("Float64", "Float32")));
  EXPECT_FALSE(is_plain(with("Float64", "String")));
  EXPECT_FALSE(is_plain(with("<DataArray", "<DataArray NumberOfComponents=\"3\"")));
  for (const char* offset : {"1", "-1", "99999999999", "18446744073709551615", "x", ""})
    EXPECT_FALSE(
        is_plain(with("offset=\"" + std::to_string(bytes.size() + 8) + "\"", std::string("offset=\"") + offset + "\"")))
        << offset;
  c.axes->values[1].pop_back();
  EXPECT_FALSE(is_plain(vtk_file(c, bytes)));
  c.axes = axes_of("Float64", 1e-3);
  c.axes->text = true;
  EXPECT_TRUE(is_plain(vtk_file(c, bytes)));
  for (const char* words : {"", "-1.7 0 ", "-1,7 ", "1e999 ", "-1.7x ", "<!-- -1.7 -->"})
    EXPECT_FALSE(is_plain(with("-1.7 ", words))) << words;
  c.axes = axes_of("Int32", 0);
  c.axes->text = true;
  EXPECT_TRUE(is_plain(vtk_file(c, bytes)));
  for (const char* words : {"-17.5 ", "99999999999 "}) EXPECT_FALSE(is_plain(with("-17 ", words))) << words;
  // After the samples.
  c = {false, true, true, true, false, "UInt8"};
  c.axes = axes_of("Float64", 1e-3);
  const std::string whole = vtk_file(c, bytes);
  EXPECT_TRUE(is_plain(whole));
  for (const std::size_t less : {12, 50, 1000}) EXPECT_FALSE(is_plain(whole.substr(0, whole.size() - less)));
  EXPECT_FALSE(is_plain(with("</Coordinates>", "</Coordinates><CellData><DataArray/></CellData>")));
  EXPECT_FALSE(is_plain(with("</Coordinates>", "</Coordinates>" + std::string(3 << 20, ' '))));
}

TEST_F(StreamedVtk, MayEndEachTextWithPadding) {
  const VtkCase one{false, true, false, true, false, "UInt8"};
  VtkCase two = one;
  two.split_text = true;
  const std::string bytes = noise(samples);
  const VolumeFile together = open_volume(folder.write("one.vti", vtk_file(one, bytes)), streaming());
  const VolumeFile apart = open_volume(folder.write("two.vti", vtk_file(two, bytes)), streaming());
  EXPECT_NE(apart.scratch, nullptr);
  EXPECT_EQ(all_samples(*together.source), all_samples(*apart.source));
}

TEST_F(StreamedVtk, ThatOtherReadersReadAreStreamedByTheirHelper) {
  TESSERA_VTK_OR_SKIP();
  const VtkCase plain{true, false, false, false, false};
  std::string text = vtk_file(plain, noise(samples * 2));
  // One more array than this program reads itself.
  text.replace(text.find("</PointData>"), 0,
               "<DataArray type=\"UInt16\" Name=\"b\" format=\"appended\" offset=\"0\"/>");
  EXPECT_TRUE(is_the_same_streamed(folder.write("two.vti", text), "rho"));
  EXPECT_TRUE(scratch.names().empty());
}

TEST_F(StreamedVtk, ThatAreDamagedAreRefusedInOneLine) {
  TESSERA_VTK_OR_SKIP();  // VTK refuses what does not fit
  const auto refused = [&](const std::string& name, const std::string& content) {
    const auto file = folder.write(name, content);
    SCOPED_TRACE(name + " of " + std::to_string(content.size()));
    test::expect_bad_input([&] { open_volume(file, streaming()); },
                           {name + ": ", "; the file is truncated or damaged"});
    EXPECT_TRUE(scratch.names().empty());
  };
  for (const VtkCase& c : {VtkCase{true, false, false, false, false}, VtkCase{true, false, true, false, false},
                           VtkCase{false, true, true, false, false}, VtkCase{true, true, false, true, false},
                           with_axes({true, false, true, true, false}, axes_of("Float64", 1e-3)),
                           with_axes({false, true, true, true, false}, axes_of("Float32", 0))}) {
    const std::string whole = vtk_file(c, noise(samples * 2));
    for (const std::size_t left : {std::size_t{300}, whole.size() / 3, whole.size() * 9 / 10})
      refused("cut.vti", whole.substr(0, left));
    if (!c.compressed) continue;
    std::string torn = whole;
    for (std::size_t k = 0; k < 12; ++k) torn[torn.size() / 2 + k] = c.base64 ? '!' : '\0';
    refused("torn.vti", torn);
  }
}

TEST_F(StreamedVtk, ThatAreDamagedAnywhereAreReadOrRefused) {
  TESSERA_VTK_OR_SKIP();
  std::mt19937 random(11);
  int refused = 0;
  test::SomeCases some(5);
  for (int trial = 0; trial < 60; ++trial) {
    if (!some.next()) continue;
    VtkCase c{(trial & 1) != 0, (trial & 1) == 0 || (trial & 2) != 0, (trial & 4) != 0, (trial & 8) != 0, false,
              "UInt8"};
    if (trial % 5 < 2) c.axes = axes_of(trial % 5 == 0 ? "Float32" : "Float64", trial % 7 * 1e-4);
    if (trial % 10 == 0) c.axes->text = true;
    std::string text = vtk_file(c, noise(samples));
    // Half of the changes are where numbers of the array may be.
    const std::size_t from = trial % 2 == 0 ? 0 : text.find("<DataArray"),
                      room = trial % 3 == 0 ? text.size() - from : 700;
    for (int k = 0; k < 3; ++k) text[from + random() % room] = static_cast<char>(random());
    const auto file = folder.write("v.vti", text);
    const test::Fault fault = test::fault_of([&] { open_volume(file, streaming()); });
    if (!fault.code) continue;
    ++refused;
    EXPECT_EQ(fault.code, scene::ErrorCode::bad_input) << "trial " << trial << ": " << fault.message;
    EXPECT_NE(fault.message.find("v.vti"), std::string::npos) << "trial " << trial << ": " << fault.message;
  }
  EXPECT_GT(refused, 10);
  EXPECT_TRUE(scratch.names().empty());
}

TEST_F(StreamedVtk, WithDamagedCoordinatesMatchVtksOwnReader) {
  TESSERA_VTK_OR_SKIP();
  std::mt19937 random(5);
  int refused = 0, plain = 0;
  for (int trial = 0; trial < 40; ++trial) {
    VtkCase c{(trial & 1) != 0,  (trial & 1) == 0 || (trial & 2) != 0,
              (trial & 4) != 0,  (trial & 8) != 0,
              (trial & 16) != 0, "UInt8"};
    c.axes = axes_of(trial % 3 == 0 ? "Float32" : "Float64", trial % 5 * 1e-4, {trial % 7 == 0, false, true});
    c.axes->text = trial % 4 == 0;
    std::string text = vtk_file(c, noise(samples));
    const std::size_t from = c.axes->text || !c.appended ? text.find("<Coordinates>") : text.size() - 2500;
    for (int k = 0; k <= trial % 2; ++k) {
      char& damaged = text[from + random() % (text.size() - from)];
      damaged = static_cast<char>(trial % 3 == 0 ? random() : static_cast<unsigned char>(damaged) ^ 1u);
    }
    const auto file = folder.write("v.vtr", text);
    std::vector<std::uint64_t> whole, parts;
    const auto geometry = [&](const ReadOptions& options) {
      return test::bits_of(open_volume(file, options).source->geometry());
    };
    const test::Fault fault = test::fault_of([&] { whole = geometry({}); });
    EXPECT_EQ(test::fault_of([&] { parts = geometry(streaming()); }).code, fault.code) << "trial " << trial;
    EXPECT_EQ(whole, parts) << "trial " << trial;
    refused += fault.code ? 1 : 0;
    plain += read_plain_vtk_grid(file, 0) ? 1 : 0;
  }
  EXPECT_GT(refused, 10);
  EXPECT_GT(plain, 10);
}

}  // namespace
}  // namespace tessera::io
