#include "io/cell_block.hpp"

#include <memory>
#include <utility>

#include "io/tuple_length.hpp"

namespace tessera::io {

BlockField field_of_values(std::string name, std::string type, scene::Association association, int components,
                           std::vector<double> values) {
  BlockField field;
  field.name = std::move(name);
  field.type = std::move(type);
  field.association = association;
  field.components = components;
  field.tuples = values.size() / static_cast<std::size_t>(components);
  const auto owned = std::make_shared<const std::vector<double>>(std::move(values));
  field.read = [owned, components](int component, std::size_t first, std::span<double> out) {
    const double* tuple = owned->data() + first * static_cast<std::size_t>(components);
    for (double& value : out) {
      value = component == magnitude ? tuple_length(tuple, components) : tuple[component];
      tuple += components;
    }
  };
  return field;
}

}  // namespace tessera::io
