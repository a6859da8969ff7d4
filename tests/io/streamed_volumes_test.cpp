// Volumes that are unpacked a part at a time into a file without a name, instead of into memory.
#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <cstring>
#include <random>

#include "io/brick_file.hpp"
#include "io/mesh_formats.hpp"
#include "io/scratch_folder.hpp"
#include "io/streamed_bricks.hpp"
#include "io/volume_bytes.hpp"
#include "io/volume_checks.hpp"
#include "io/vtk_or_skip.hpp"

namespace tessera::io {
namespace {

using test::all_samples;
using test::bytes_of;

constexpr std::int16_t nx = 70, ny = 65, nz = 130;
constexpr std::size_t samples = std::size_t{nx} * ny * nz;

std::string noise(std::size_t bytes) {
  std::mt19937 random(3);
  std::string text(bytes, '\0');
  // Some bits only, so that there is something to pack.
  for (char& c : text) c = static_cast<char>(random() & 15);
  return text;
}

std::string zlib_of(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string packed(size, '\0');
  EXPECT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                     bytes.size()),
            Z_OK);
  packed.resize(size);
  return packed;
}

std::string base64_of(const std::string& bytes) {
  constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t bits = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (k < count ? static_cast<unsigned char>(bytes[at + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? letters[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

template <class T>
std::string number(T value, bool big) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  if (big) std::ranges::reverse(bytes);
  return bytes;
}

/// A .vti of one array, packed in every way that writers have.
struct VtiCase {
  bool appended, base64, compressed, wide_numbers, big_endian;
  std::string type = "UInt16";
  int components = 1;
  bool of_cells = false;
  bool split_text = false;  ///< base64: the number's and the bytes' text each with its own padding
};

std::string array_of(const VtiCase& c, const std::string& bytes) {
  const auto numbers = [&](std::uint64_t n) {
    return c.wide_numbers ? number(n, c.big_endian) : number(static_cast<std::uint32_t>(n), c.big_endian);
  };
  const auto text = [&](const std::string& raw) { return c.base64 ? base64_of(raw) : raw; };
  if (!c.compressed)
    return c.split_text ? text(numbers(bytes.size())) + text(bytes) : text(numbers(bytes.size()) + bytes);
  constexpr std::size_t block = 32768;
  std::string table, packed;
  std::size_t blocks = 0;
  for (std::size_t at = 0; at < bytes.size(); at += block, ++blocks) {
    const std::string one = zlib_of(bytes.substr(at, block));
    table += numbers(one.size()), packed += one;
  }
  return text(numbers(blocks) + numbers(block) + numbers(bytes.size() % block) + table) + text(packed);
}

std::string vti(const VtiCase& c, const std::string& bytes) {
  const auto extent = [&](int low, int n) {
    return std::to_string(low) + " " + std::to_string(low + n - (c.of_cells ? 0 : 1));
  };
  const std::string whole = extent(-3, nx) + " " + extent(0, ny) + " " + extent(5, nz);
  const std::string fields = c.of_cells ? "CellData" : "PointData";
  std::string head =
      std::string("<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"") +
      (c.big_endian ? "BigEndian" : "LittleEndian") + "\" header_type=\"" + (c.wide_numbers ? "UInt64" : "UInt32") +
      "\"" + (c.compressed ? " compressor=\"vtkZLibDataCompressor\"" : "") + ">\n<ImageData WholeExtent=\"" + whole +
      "\" Origin=\"1 2 3\" Spacing=\"0.5 2 0.25\" Direction=\"0 -1 0 1 0 0 0 0 1\">\n<Piece Extent=\"" + whole +
      "\"><" + fields + " Scalars=\"rho\"><DataArray type=\"" + c.type + "\" Name=\"rho\" NumberOfComponents=\"" +
      std::to_string(c.components) + "\" ";
  const std::string ends = "</" + fields + "></Piece></ImageData>";
  const std::string array = array_of(c, bytes);
  if (!c.appended) return head + "format=\"binary\">\n  " + array + "\n</DataArray>" + ends + "</VTKFile>\n";
  return head + "format=\"appended\" offset=\"0\"/>" + ends + "<AppendedData encoding=\"" +
         (c.base64 ? "base64" : "raw") + "\">\n  _" + array + "\n</AppendedData></VTKFile>\n";
}

/// Lengths of vectors are rounded to floats where they are stored; all other samples here are floats or shorter, or
/// whole numbers.
std::vector<float> floats_of(const scene::SampleSource& source) {
  std::vector<float> values(static_cast<std::size_t>(source.geometry().all_samples().count()));
  source.read(source.geometry().all_samples(), std::span<float>(values));
  return values;
}

class StreamedVolumes : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path zipped(const std::string& name, const std::string& content) const {
    const std::filesystem::path file = folder / name;
    gzFile out = gzopen(file.c_str(), "wb");
    EXPECT_EQ(gzwrite(out, content.data(), static_cast<unsigned>(content.size())), static_cast<int>(content.size()));
    gzclose(out);
    return file;
  }
  static VolumeOptions streaming(const std::string& field = "") {
    VolumeOptions options;
    options.field = field;
    options.most_in_memory = 0;
    return options;
  }
  /// Samples and description of `file` must be the same unpacked into memory and into a file; whether it was.
  static bool is_the_same_streamed(const std::filesystem::path& file, const std::string& field = "") {
    const VolumeFile whole = open_volume(file, {.field = field}), parts = open_volume(file, streaming(field));
    EXPECT_EQ(whole.scratch, nullptr);
    EXPECT_EQ(floats_of(*whole.source), floats_of(*parts.source)) << file;
    EXPECT_EQ(whole.source->geometry(), parts.source->geometry()) << file;
    EXPECT_EQ(whole.source->grid().type, parts.source->grid().type);
    EXPECT_EQ(whole.source->grid().scale, parts.source->grid().scale);
    EXPECT_EQ(whole.source->grid().field_name, parts.source->grid().field_name);
    EXPECT_EQ(whole.range, parts.range) << file;
    EXPECT_EQ(whole.notes, parts.notes);
    EXPECT_EQ(whole.format, parts.format);
    EXPECT_EQ(whole.fields.size(), parts.fields.size());
    for (std::size_t k = 0; k < std::min(whole.fields.size(), parts.fields.size()); ++k) {
      const FieldSummary &a = whole.fields[k], &b = parts.fields[k];
      EXPECT_EQ(a.name, b.name);
      EXPECT_EQ(a.association, b.association);
      EXPECT_EQ(a.components, b.components);
      EXPECT_EQ(a.type, b.type);
      if (a.components == 1) {
        EXPECT_EQ(a.low, b.low) << file;
        EXPECT_EQ(a.high, b.high) << file;
      } else {  // rounded to floats, as lengths are stored
        EXPECT_EQ(static_cast<float>(a.low), static_cast<float>(b.low)) << file;
        EXPECT_EQ(static_cast<float>(a.high), static_cast<float>(b.high)) << file;
      }
      EXPECT_EQ(a.nan_count, b.nan_count);
      EXPECT_EQ(a.active, b.active) << file;
    }
    EXPECT_EQ(parts.in_memory, false) << file;
    return parts.scratch != nullptr;
  }

  const test::TemporaryFolder folder, scratch;
  const test::ScratchFolder scratch_folder{scratch.path()};
};

std::string nifti_of(std::int16_t type, int bytes_each, std::int16_t steps = 1) {
  std::string header = test::nifti_header();
  const std::int16_t dim[] = {static_cast<std::int16_t>(steps > 1 ? 4 : 3), nx, ny, nz, steps, 1, 1, 1};
  std::memcpy(header.data() + 40, dim, sizeof dim);
  test::put<std::int16_t>(header, 70, type);
  test::put<float>(header, 112, 2.5f);
  test::put<float>(header, 116, -1.0f);
  return header + noise(samples * static_cast<std::size_t>(bytes_each) * static_cast<std::size_t>(steps));
}

TEST_F(StreamedVolumes, OfGzipAreWhatMemoryWouldHold) {
  EXPECT_TRUE(is_the_same_streamed(zipped("bytes.nii.gz", nifti_of(2, 1))));
  EXPECT_TRUE(is_the_same_streamed(zipped("doubles.nii.gz", nifti_of(64, 8))));
  EXPECT_TRUE(is_the_same_streamed(zipped("steps.nii.gz", nifti_of(4, 2, 3))));
  // In members, and with zeros behind the last one.
  const std::string whole = nifti_of(2, 1);
  const std::string first = test::contents(zipped("1.gz", whole.substr(0, 100'000))),
                    second = test::contents(zipped("2.gz", whole.substr(100'000)));
  EXPECT_TRUE(is_the_same_streamed(folder.write("members.nii.gz", first + second + std::string(100, '\0'))));
  EXPECT_TRUE(scratch.names().empty());
}

TEST_F(StreamedVolumes, OfVectorsHaveOneNumberOfEachOrTheirLengths) {
  const std::string header =
      "NRRD0004\ntype: short\ndimension: 4\nkinds: vector domain domain domain\nsizes: 3 70 65 130\n"
      "endian: big\nencoding: gzip\n\n";
  const auto file = folder.write("v.nrrd", header + test::contents(zipped("samples", noise(samples * 6))));
  EXPECT_TRUE(is_the_same_streamed(file));
  EXPECT_TRUE(is_the_same_streamed(file, "samples:1"));
}

TEST_F(StreamedVolumes, ThatComeInOneOrderOnlyStayInMemory) {
  std::string header = test::nifti_header();
  const std::int16_t dim[] = {5, nx, ny, nz, 1, 3, 1, 1};  // all of a component together
  std::memcpy(header.data() + 40, dim, sizeof dim);
  const auto file = zipped("planes.nii.gz", header + noise(samples * 6));
  const VolumeFile volume = open_volume(file, streaming());
  EXPECT_TRUE(volume.in_memory);
  EXPECT_EQ(volume.scratch, nullptr);
}

TEST_F(StreamedVolumes, OfVtkAreWhatItsOwnReaderFinds) {
  TESSERA_VTK_OR_SKIP();
  // appended, base64, compressed, wide numbers, big endian
  const VtiCase cases[] = {{true, false, false, false, false},
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
  for (std::size_t k = 0; k < std::size(cases); ++k) {
    const VtiCase& c = cases[k];
    const std::size_t each = c.type.back() == '8' ? 1 : c.type.ends_with("16") ? 2 : c.type.ends_with("32") ? 4 : 8;
    const auto file = folder.write(std::to_string(k) + ".vti",
                                   vti(c, noise(samples * each * static_cast<std::size_t>(c.components))));
    // Raw ones need not be unpacked.
    EXPECT_EQ(is_the_same_streamed(file), c.base64 || c.compressed) << k;
    if (c.components > 1) is_the_same_streamed(file, "rho:1");
  }
}

TEST_F(StreamedVolumes, OfVtkMayEndEachTextWithPadding) {
  const VtiCase one{false, true, false, true, false, "UInt8"};
  VtiCase two = one;
  two.split_text = true;
  const std::string bytes = noise(samples);
  const VolumeFile together = open_volume(folder.write("one.vti", vti(one, bytes)), streaming());
  const VolumeFile apart = open_volume(folder.write("two.vti", vti(two, bytes)), streaming());
  EXPECT_NE(apart.scratch, nullptr);
  EXPECT_EQ(all_samples(*together.source), all_samples(*apart.source));
}

TEST_F(StreamedVolumes, ThatOthersReadComeThroughTheirHelper) {
  TESSERA_VTK_OR_SKIP();
  const VtiCase plain{true, false, false, false, false};
  std::string text = vti(plain, noise(samples * 2));
  // An array more than this program reads itself.
  text.replace(text.find("</PointData>"), 0,
               "<DataArray type=\"UInt16\" Name=\"b\" format=\"appended\" offset=\"0\"/>");
  EXPECT_TRUE(is_the_same_streamed(folder.write("two.vti", text), "rho"));
  EXPECT_TRUE(scratch.names().empty());
}

TEST_F(StreamedVolumes, ThatAreDamagedAreRefusedInOneLine) {
  const std::string zipped_whole = test::contents(zipped("a.nii.gz", nifti_of(2, 1)));
  const auto refused = [&](const std::string& name, const std::string& content) {
    const auto file = folder.write(name, content);
    SCOPED_TRACE(name + " of " + std::to_string(content.size()));
    test::expect_bad_input([&] { open_volume(file, streaming()); }, {name + ": ", "write it anew"});
    EXPECT_TRUE(scratch.names().empty());
  };
  for (const std::size_t left : {std::size_t{400}, zipped_whole.size() / 2, zipped_whole.size() - 500})
    refused("cut.nii.gz", zipped_whole.substr(0, left));
  TESSERA_VTK_OR_SKIP();  // what does not fit is VTK's to refuse
  for (const VtiCase& c : {VtiCase{true, false, false, false, false}, VtiCase{true, false, true, false, false},
                           VtiCase{false, true, true, false, false}, VtiCase{true, true, false, true, false}}) {
    const std::string whole = vti(c, noise(samples * 2));
    for (const std::size_t left : {std::size_t{300}, whole.size() / 3, whole.size() * 9 / 10})
      refused("cut.vti", whole.substr(0, left));
    if (!c.compressed) continue;
    std::string torn = whole;
    for (std::size_t k = 0; k < 12; ++k) torn[torn.size() / 2 + k] = c.base64 ? '!' : '\0';
    refused("torn.vti", torn);
  }
}

TEST_F(StreamedVolumes, ThatAreDamagedAnywhereAreReadOrRefused) {
  TESSERA_VTK_OR_SKIP();
  std::mt19937 random(11);
  int refused = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const VtiCase c{(trial & 1) != 0, (trial & 1) == 0 || (trial & 2) != 0, (trial & 4) != 0, (trial & 8) != 0, false,
                    "UInt8"};
    std::string text = vti(c, noise(samples));
    // Half of them where numbers of the array may be.
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

TEST_F(StreamedVolumes, GoIntoAFileIfTheyAreLargeAndThereIsRoom) {
  const auto file = zipped("a.nii.gz", nifti_of(2, 1));
  VolumeOptions options;
  options.most_in_memory = samples;
  EXPECT_EQ(open_volume(file, options).scratch, nullptr);
  options.most_in_memory = samples - 1;
  EXPECT_NE(open_volume(file, options).scratch, nullptr);
  const test::ScratchFolder nowhere(scratch / "nowhere");
  EXPECT_TRUE(open_volume(file, options).in_memory);
  options.scratch_is_needed = true;
  test::expect_bad_input([&] { open_volume(file, options); }, {"a.nii.gz: its samples", "set TMPDIR"});
}

TEST_F(StreamedVolumes, AreWrittenInAnyPartsThatTheyComeIn) {
  StreamedSamples streamed;
  streamed.grid.geometry.points = {nx, ny, nz};
  streamed.grid.type = scene::SampleType::uint8;
  streamed.choice.type = scene::SampleType::uint8;
  const std::string bytes = noise(samples);
  std::vector<double> expected;
  for (const std::size_t part : {std::size_t{1000}, std::size_t{nx} * ny, std::size_t{12'345}, samples}) {
    streamed.tuples = [&](const ByteSink& use) {
      for (std::size_t at = 0; at < bytes.size(); at += part)
        use(std::as_bytes(std::span(bytes).subspan(at, std::min(part, bytes.size() - at))));
    };
    const auto file = scratch_bricks(streamed, "v");
    const VolumeFile back = open_bricks(file->path(), {}, "v");
    const std::vector<double> read = all_samples(*back.source);
    if (expected.empty()) expected = read;
    EXPECT_EQ(read, expected) << part;
    EXPECT_EQ(scene::value_range(*back.source), value_range(streamed));
  }
  for (std::size_t k = 0; k < samples; ++k) ASSERT_EQ(expected[k], static_cast<double>(bytes[k]));
}

}  // namespace
}  // namespace tessera::io
