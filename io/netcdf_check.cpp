#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <vector>

#include "io/vtk_checks.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

class NetcdfCheck {
 public:
  NetcdfCheck(std::string_view bytes, const std::string& source) : bytes_(bytes), source_(source) {}

  void run() {
    if (bytes_.size() < 4 || (bytes_[3] != 1 && bytes_[3] != 2 && bytes_[3] != 5))
      fail("its NetCDF version is unknown");
    version_ = bytes_[3];
    at_ = 4;
    const std::uint64_t records = count_field();
    streaming_ = version_ == 5 ? records == UINT64_MAX : records == UINT32_MAX;
    read_dimensions();
    read_attributes();
    read_variables();
    std::uint64_t record_bytes = 0;
    for (const Variable& v : variables_)
      if (v.is_record) record_bytes += v.bytes;
    for (const Variable& v : variables_) {
      std::uint64_t end = 0;
      bool too_large = v.begin > bytes_.size() || __builtin_add_overflow(v.begin, v.bytes, &end);
      if (v.is_record && !streaming_ && records > 0) {
        std::uint64_t before_last = 0;
        too_large = too_large || __builtin_mul_overflow(records - 1, record_bytes, &before_last) ||
                    __builtin_add_overflow(end, before_last, &end);
      }
      // The last variable's padding may be missing.
      if ((!v.is_record || records > 0) && (too_large || end > bytes_.size() + 3))
        fail(fmt::format("variable '{}' reaches past the end of its {} bytes", v.name, bytes_.size()));
    }
  }

 private:
  struct Variable {
    std::string name;
    std::uint64_t begin, bytes;  ///< of one record if it has records
    bool is_record;
  };

  [[noreturn]] void fail(const std::string& what) const {
    throw scene::bad_input(fmt::format("{}: {}; the file is truncated or damaged, write it anew", source_, what));
  }

  std::uint64_t number(int size) {
    if (bytes_.size() - at_ < static_cast<std::size_t>(size)) fail("its NetCDF header does not end");
    std::uint64_t value = 0;
    for (int k = 0; k < size; ++k) value = value << 8 | static_cast<unsigned char>(bytes_[at_++]);
    return value;
  }
  std::uint64_t count_field() { return number(version_ == 5 ? 8 : 4); }

  /// A count of things that take at least `least` bytes each in what is left.
  std::uint64_t count(const char* what, std::uint64_t least) {
    const std::uint64_t n = count_field();
    if (n > (bytes_.size() - at_) / least) fail(fmt::format("its NetCDF header promises {} {}", n, what));
    return n;
  }

  /// The number of entries of a list that begins with `tag`; an absent list is two zeros.
  std::uint64_t list(std::uint64_t tag, const char* what) {
    const std::uint64_t found = number(4);
    const std::uint64_t n = count(what, 8);
    if (found != tag && !(found == 0 && n == 0)) fail(fmt::format("its NetCDF header has no list of {}", what));
    return n;
  }

  void skip(std::uint64_t bytes) {
    const std::uint64_t padded = (bytes + 3) & ~std::uint64_t{3};
    if (padded > bytes_.size() - at_) fail("its NetCDF header does not end");
    at_ += padded;
  }

  std::string name() {
    const std::uint64_t n = count("letters of a name", 1);
    std::string text(bytes_.substr(at_, n));
    for (char& c : text)
      if (c < ' ' || c > '~') c = '?';
    skip(n);
    return text.substr(0, 60);
  }

  std::uint64_t type_size() {
    static constexpr std::uint64_t sizes[] = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    const std::uint64_t type = number(4);
    if (type < 1 || type > 11) fail(fmt::format("its NetCDF header holds the type {}", type));
    return sizes[type];
  }

  void read_dimensions() {
    dimensions_.resize(list(10, "dimensions"));
    for (std::uint64_t& length : dimensions_) {
      name();
      length = count_field();
    }
  }

  void read_attributes() {
    for (std::uint64_t n = list(12, "attributes"); n > 0; --n) {
      name();
      const std::uint64_t size = type_size();
      skip(count("values of an attribute", size) * size);
    }
  }

  void read_variables() {
    for (std::uint64_t n = list(11, "variables"); n > 0; --n) {
      Variable v{name(), 0, 0, false};
      std::uint64_t values = 1;
      const std::uint64_t rank = count("dimensions of a variable", 4);
      for (std::uint64_t d = 0; d < rank; ++d) {
        const std::uint64_t dimension = count_field();
        if (dimension >= dimensions_.size()) fail(fmt::format("variable '{}' has no dimension {}", v.name, dimension));
        if (d == 0 && dimensions_[dimension] == 0)
          v.is_record = true;  // the dimension without a length of its own
        else if (__builtin_mul_overflow(values, dimensions_[dimension], &values))
          fail(fmt::format("variable '{}' is larger than any file", v.name));
      }
      read_attributes();
      if (__builtin_mul_overflow(values, type_size(), &v.bytes) || v.bytes > bytes_.size())
        fail(fmt::format("variable '{}' is larger than the file", v.name));
      v.bytes = (v.bytes + 3) & ~std::uint64_t{3};
      count_field();  // vsize, which is redundant
      v.begin = number(version_ == 1 ? 4 : 8);
      variables_.push_back(std::move(v));
    }
  }

  std::string_view bytes_;
  const std::string& source_;
  std::size_t at_ = 0;
  int version_ = 1;
  bool streaming_ = false;  ///< the writer did not know the number of records
  std::vector<std::uint64_t> dimensions_;
  std::vector<Variable> variables_;
};

}  // namespace

void check_netcdf_classic(std::string_view bytes, const std::string& source) { NetcdfCheck(bytes, source).run(); }

}  // namespace tessera::io
