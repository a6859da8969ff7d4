// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/hdf5/hdf5_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "readers/vtk/hdf5/hdf5_lzf.hpp"
#include "scene/error.hpp"
#include "tessera/program/text.hpp"

namespace tessera::readers {
namespace {

/// Returns our type for the numbers of a file; no value for texts, compounds and others.
std::optional<NumberType> number_type_of(hid_t type) {
  const H5T_class_t kind = H5Tget_class(type);
  if (kind == H5T_ENUM) {  // h5py stores bool as an enumeration
    const Hdf5Handle base(H5Tget_super(type), H5Tclose);
    return number_type_of(base.get());
  }
  const std::size_t size = H5Tget_size(type);
  if (kind == H5T_FLOAT) return size <= 4 ? NumberType::float32 : NumberType::float64;
  if (kind != H5T_INTEGER || size > 8) return std::nullopt;
  const bool is_signed = H5Tget_sign(type) != H5T_SGN_NONE;
  if (size == 1) return is_signed ? NumberType::int8 : NumberType::uint8;
  if (size == 2) return is_signed ? NumberType::int16 : NumberType::uint16;
  if (size <= 4) return is_signed ? NumberType::int32 : NumberType::uint32;
  return is_signed ? NumberType::int64 : NumberType::uint64;
}

hid_t library_type_of(NumberType type) {
  switch (type) {
    case NumberType::int8:
      return H5T_NATIVE_INT8;
    case NumberType::uint8:
      return H5T_NATIVE_UINT8;
    case NumberType::int16:
      return H5T_NATIVE_INT16;
    case NumberType::uint16:
      return H5T_NATIVE_UINT16;
    case NumberType::int32:
      return H5T_NATIVE_INT32;
    case NumberType::uint32:
      return H5T_NATIVE_UINT32;
    case NumberType::int64:
      return H5T_NATIVE_INT64;
    case NumberType::uint64:
      return H5T_NATIVE_UINT64;
    case NumberType::float32:
      return H5T_NATIVE_FLOAT;
    case NumberType::float64:
      break;
  }
  return H5T_NATIVE_DOUBLE;
}

/// Returns the first of an array's filters that the library does not support, like "gzip (1)"; empty if there is none.
std::string missing_filter(hid_t array) {
  const Hdf5Handle creation(H5Dget_create_plist(array), H5Pclose);
  const int filters = H5Pget_nfilters(creation.get());
  for (int k = 0; k < filters; ++k) {
    std::array<char, 64> name{};
    unsigned flags = 0, settings = 0;
    std::size_t parameters = 0;
    const H5Z_filter_t filter = H5Pget_filter2(creation.get(), static_cast<unsigned>(k), &flags, &parameters, nullptr,
                                               name.size() - 1, name.data(), &settings);
    if (filter >= 0 && H5Zfilter_avail(filter) <= 0)
      return fmt::format("{} ({})", quote(std::string(name.data())), filter);
  }
  return "";
}

extern "C" herr_t tessera_note_link(hid_t, const char* name, const H5L_info_t* link, void* paths) {
  constexpr std::size_t most = 100000;
  auto& found = *static_cast<std::vector<std::string>*>(paths);
  if (link->type == H5L_TYPE_HARD) found.emplace_back(name);
  return found.size() < most ? 0 : 1;
}

}  // namespace

Hdf5File::Hdf5File(const std::filesystem::path& file)
    : source_(file.string()),
      file_(
          [&] {
            H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // otherwise the library would print errors
            register_lzf();
            return H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
          }(),
          H5Fclose) {}

std::string Hdf5File::text_of(const char* object, const char* name) const {
  if (H5Aexists_by_name(file_.get(), object, name, H5P_DEFAULT) <= 0) return "";
  const Hdf5Handle attribute(H5Aopen_by_name(file_.get(), object, name, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const Hdf5Handle type(H5Aget_type(attribute.get()), H5Tclose), space(H5Aget_space(attribute.get()), H5Sclose);
  std::string text;
  constexpr std::size_t most = 256;
  if (H5Tget_class(type.get()) != H5T_STRING || H5Sget_simple_extent_npoints(space.get()) != 1) return "";
  if (H5Tis_variable_str(type.get()) > 0) {
    char* words = nullptr;
    if (H5Aread(attribute.get(), type.get(), &words) >= 0 && words != nullptr)
      text.assign(words, std::min(std::char_traits<char>::length(words), most));
    H5free_memory(words);
  } else if (H5Tget_size(type.get()) <= most && H5Aget_storage_size(attribute.get()) <= most) {
    text.resize(most);
    if (H5Aread(attribute.get(), type.get(), text.data()) < 0) text.clear();
  }
  return text.substr(0, text.find('\0'));
}

std::vector<double> Hdf5File::numbers_of(const char* object, const char* name) const {
  if (H5Aexists_by_name(file_.get(), object, name, H5P_DEFAULT) <= 0) return {};
  const Hdf5Handle attribute(H5Aopen_by_name(file_.get(), object, name, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const Hdf5Handle type(H5Aget_type(attribute.get()), H5Tclose), space(H5Aget_space(attribute.get()), H5Sclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space.get());
  constexpr hssize_t most = 1000;
  if (count <= 0 || count > most || !number_type_of(type.get())) return {};
  std::vector<double> numbers(static_cast<std::size_t>(count));
  if (H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, numbers.data()) < 0) numbers.clear();
  return numbers;
}

long Hdf5File::number_of(const char* object, const char* name, long otherwise) const {
  const std::vector<double> numbers = numbers_of(object, name);
  return numbers.size() == 1 ? static_cast<long>(numbers.front()) : otherwise;
}

std::optional<Hdf5Array> Hdf5File::array_at(const std::string& path) const {
  const Hdf5Handle object(H5Oopen(file_.get(), path.c_str(), H5P_DEFAULT), H5Oclose);
  if (!object.is_open() || H5Iget_type(object.get()) != H5I_DATASET) return std::nullopt;
  const Hdf5Handle type(H5Dget_type(object.get()), H5Tclose), space(H5Dget_space(object.get()), H5Sclose);
  const std::optional<NumberType> number = number_type_of(type.get());
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (!number || rank <= 0 || rank > H5S_MAX_RANK) return std::nullopt;
  std::array<hsize_t, H5S_MAX_RANK> lengths{};
  H5Sget_simple_extent_dims(space.get(), lengths.data(), nullptr);
  Hdf5Array array{path, *number, {}};
  array.lengths.assign(lengths.begin(), lengths.begin() + rank);
  return array;
}

std::vector<Hdf5Array> Hdf5File::arrays(const std::string& group) const {
  std::vector<std::string> paths;
  std::vector<Hdf5Array> found;
  const Hdf5Handle within(H5Gopen2(file_.get(), group.c_str(), H5P_DEFAULT), H5Gclose);
  if (!within.is_open()) return found;
  H5Lvisit(within.get(), H5_INDEX_NAME, H5_ITER_NATIVE, tessera_note_link, &paths);
  for (const std::string& path : paths)
    if (auto array = array_at(group == "/" ? path : group + "/" + path)) found.push_back(*std::move(array));
  return found;
}

bool Hdf5File::has_scales(const Hdf5Array& array) const {
  return H5Aexists_by_name(file_.get(), array.path.c_str(), "DIMENSION_LIST", H5P_DEFAULT) > 0;
}

GridNumbers Hdf5File::read(const Hdf5Array& array, std::span<const std::size_t> first,
                           std::span<const std::size_t> counts) const {
  const Hdf5Handle opened(H5Dopen2(file_.get(), array.path.c_str(), H5P_DEFAULT), H5Dclose);
  const std::string name = quote(array.path);
  if (const std::string filter = missing_filter(opened.get()); !filter.empty())
    throw scene::bad_input(fmt::format(
        "{}: {} is compressed by the filter {}, which is not installed here; unpack it with h5repack -f NONE", source_,
        name, filter));
  double bytes = static_cast<double>(io::size_of(array.type));
  std::size_t count = 1;
  for (const std::size_t n : counts) bytes *= static_cast<double>(n), count *= n;
  if (bytes > 0x1p60) throw std::bad_alloc();
  GridNumbers numbers{array.type, std::vector<std::byte>(count * io::size_of(array.type))};
  const std::vector<hsize_t> start(first.begin(), first.end()), block(counts.begin(), counts.end());
  const Hdf5Handle in_file(H5Dget_space(opened.get()), H5Sclose),
      in_memory(H5Screate_simple(static_cast<int>(block.size()), block.data(), nullptr), H5Sclose),
      type(H5Dget_type(opened.get()), H5Tclose);
  // The numbers of an enumeration have the enumeration's base type.
  const Hdf5Handle enumeration(
      H5Tget_class(type.get()) == H5T_ENUM ? H5Tget_native_type(type.get(), H5T_DIR_ASCEND) : H5I_INVALID_HID,
      H5Tclose);
  const hid_t as = enumeration.is_open() ? enumeration.get() : library_type_of(array.type);
  if (H5Sselect_hyperslab(in_file.get(), H5S_SELECT_SET, start.data(), nullptr, block.data(), nullptr) < 0 ||
      H5Tget_size(as) != io::size_of(array.type) ||
      H5Dread(opened.get(), as, in_memory.get(), in_file.get(), H5P_DEFAULT, numbers.bytes.data()) < 0)
    throw scene::bad_input(
        fmt::format("{}: {} cannot be read; the file is truncated or damaged, write it again", source_, name));
  return numbers;
}

}  // namespace tessera::readers
