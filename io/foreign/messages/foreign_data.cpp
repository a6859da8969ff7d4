// SPDX-License-Identifier: BSD-3-Clause
#include "io/foreign/messages/foreign_data.hpp"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "cells/cell_block.hpp"
#include "cells/tuple_length.hpp"

namespace tessera::io {
namespace {

using Json = nlohmann::json;

Json json_of(const ForeignArray& a) {
  const cells::NumberTally& t = a.tally;
  return {a.number,     a.name,       static_cast<int>(a.type),
          a.components, a.tuples,     a.active,
          t.low,        t.high,       t.not_finite,
          t.any_finite, a.ids,        t.whole,
          t.finite,     t.fingerprint};
}

ForeignArray array_of(const Json& json) {
  ForeignArray a;
  a.number = json.at(0).get<std::uint64_t>();
  a.name = json.at(1).get<std::string>();
  const int type = json.at(2).get<int>();
  if (type < 0 || type > static_cast<int>(NumberType::float64)) throw std::invalid_argument("type of an array");
  a.type = static_cast<NumberType>(type);
  a.components = json.at(3).get<int>();
  a.tuples = json.at(4).get<std::uint64_t>();
  a.active = json.at(5).get<bool>();
  a.tally = {json.at(6).get<double>(),        json.at(7).get<double>(), json.at(8).get<std::uint64_t>(),
             json.at(9).get<bool>(),          json.at(11).get<bool>(),  json.at(12).get<std::uint64_t>(),
             json.at(13).get<std::uint64_t>()};
  a.ids = json.at(10).get<bool>();
  // Limits that keep bytes() from overflowing.
  if (a.components < 1 || a.components > 1 << 20 || a.tuples > 1ull << 40)
    throw std::invalid_argument("size of an array");
  return a;
}

Json json_of(const std::optional<ForeignArray>& a) { return a ? json_of(*a) : Json(); }
std::optional<ForeignArray> optional_of(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional(array_of(json));
}

Json json_of(const std::vector<ForeignArray>& arrays) {
  Json list = Json::array();
  for (const ForeignArray& a : arrays) list.push_back(json_of(a));
  return list;
}
std::vector<ForeignArray> arrays_of(const Json& list) {
  std::vector<ForeignArray> arrays;
  for (const Json& a : list) arrays.push_back(array_of(a));
  return arrays;
}

Json json_of(const ForeignPart& p) {
  return {{"kind", static_cast<int>(p.kind)},
          {"name", p.name},
          {"extent", p.extent},
          {"origin", p.origin},
          {"spacing", p.spacing},
          {"direction", p.direction},
          {"points", json_of(p.points)},
          {"types", json_of(p.types)},
          {"offsets", json_of(p.offsets)},
          {"connectivity", json_of(p.connectivity)},
          {"faces", json_of(p.faces)},
          {"face_locations", json_of(p.face_locations)},
          {"coordinates", json_of(p.coordinates)},
          {"branching", p.branching},
          {"levels", p.levels},
          {"point_fields", json_of(p.point_fields)},
          {"cell_fields", json_of(p.cell_fields)}};
}

ForeignPart part_of(const Json& json) {
  ForeignPart p;
  const int kind = json.at("kind").get<int>();
  if (kind < 0 || kind > static_cast<int>(ForeignPart::Kind::trees)) throw std::invalid_argument("kind of a part");
  p.kind = static_cast<ForeignPart::Kind>(kind);
  json.at("name").get_to(p.name);
  json.at("extent").get_to(p.extent);
  json.at("origin").get_to(p.origin);
  json.at("spacing").get_to(p.spacing);
  json.at("direction").get_to(p.direction);
  p.points = optional_of(json.at("points"));
  p.types = optional_of(json.at("types"));
  p.offsets = optional_of(json.at("offsets"));
  p.connectivity = optional_of(json.at("connectivity"));
  p.faces = optional_of(json.at("faces"));
  p.face_locations = optional_of(json.at("face_locations"));
  p.coordinates = arrays_of(json.at("coordinates"));
  json.at("branching").get_to(p.branching);
  json.at("levels").get_to(p.levels);
  p.point_fields = arrays_of(json.at("point_fields"));
  p.cell_fields = arrays_of(json.at("cell_fields"));
  return p;
}

template <class T>
void copy_tuples(const T* values, int components, int component, std::size_t first, std::span<double> out) {
  const T* tuple = values + first * static_cast<std::size_t>(components);
  for (double& value : out) {
    value =
        component == cells::magnitude ? cells::tuple_length(tuple, components) : static_cast<double>(tuple[component]);
    tuple += components;
  }
}

}  // namespace

void read_tuples(std::span<const std::byte> bytes, NumberType type, int components, int component, std::size_t first,
                 std::span<double> out) {
  with_number_type(type, [&](auto zero) {
    copy_tuples(reinterpret_cast<const decltype(zero)*>(bytes.data()), components, component, first, out);
  });
}

std::vector<std::uint8_t> bytes_of(const ForeignContents& contents) {
  Json parts = Json::array();
  for (const ForeignPart& part : contents.parts) parts.push_back(json_of(part));
  return Json::to_cbor({{"parts", std::move(parts)},
                        {"notes", contents.notes},
                        {"format", contents.format},
                        {"modality", contents.modality},
                        {"unit", contents.unit},
                        {"block_names", contents.block_names},
                        {"surface_names", contents.surface_names},
                        {"time_steps", contents.time_step.count},
                        {"time_step", contents.time_step.step},
                        {"times", contents.time_step.times},
                        {"labels", contents.labels},
                        {"xy_in_degrees", contents.xy_in_degrees},
                        {"has_levels", contents.has_levels}});
}

ForeignContents contents_of(std::span<const std::uint8_t> bytes) {
  const Json json = Json::from_cbor(bytes.begin(), bytes.end());
  ForeignContents contents;
  for (const Json& part : json.at("parts")) contents.parts.push_back(part_of(part));
  json.at("notes").get_to(contents.notes);
  json.at("format").get_to(contents.format);
  json.at("modality").get_to(contents.modality);
  json.at("unit").get_to(contents.unit);
  json.at("block_names").get_to(contents.block_names);
  json.at("surface_names").get_to(contents.surface_names);
  json.at("time_steps").get_to(contents.time_step.count);
  json.at("time_step").get_to(contents.time_step.step);
  json.at("times").get_to(contents.time_step.times);
  json.at("labels").get_to(contents.labels);
  json.at("xy_in_degrees").get_to(contents.xy_in_degrees);
  json.at("has_levels").get_to(contents.has_levels);
  return contents;
}

}  // namespace tessera::io
