// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <initializer_list>
#include <string_view>
#include <utility>

#include "tessera/annotation.hpp"
#include "tessera/camera.hpp"
#include "tessera/mechanisms.hpp"
#include "tessera/settings.hpp"

/// For each option with several choices: the values that its words denote, in the order of the words in the option
/// table. OptionWords::choice() converts words to values, State::set() converts values to words.
namespace tessera::api {

template <class T>
using Choices = std::initializer_list<T>;

inline constexpr Choices<bool> off_on = {false, true};
inline constexpr Choices<bool> on_off = {true, false};
inline constexpr Choices<int> png_depths = {8, 16};
inline constexpr Choices<ProjectionKind> projections = {ProjectionKind::orthographic, ProjectionKind::perspective};
inline constexpr Choices<Emission> emissions = {Emission::absorption, Emission::independent};
inline constexpr Choices<Rasterizer> rasterizers = {Rasterizer::planes, Rasterizer::scanline, Rasterizer::device};
inline constexpr Choices<EdgeBricks> edge_brick_kinds = {EdgeBricks::variable, EdgeBricks::fixed};
inline constexpr Choices<CachePolicy> cache_policies = {CachePolicy::lru, CachePolicy::proximity};
inline constexpr Choices<Distribution> distributions = {Distribution::sort_first, Distribution::sort_last};
inline constexpr Choices<DirectSend> direct_sends = {DirectSend::asynchronous, DirectSend::synchronous};
inline constexpr Choices<Balance> balances = {Balance::learned,   Balance::accurate, Balance::backface,
                                              Balance::splatting, Balance::previous, Balance::even};
inline constexpr Choices<Exchange> exchanges = {Exchange::runs, Exchange::segments};
inline constexpr Choices<PartitionKind> partition_kinds = {PartitionKind::curve, PartitionKind::file,
                                                           PartitionKind::random};
inline constexpr Choices<Backend> backend_kinds = {Backend::automatic, Backend::cpu, Backend::osmesa, Backend::egl};

/// The names that `without` accepts, in addition to merging.
inline constexpr std::pair<std::string_view, bool Mechanisms::*> mechanisms[] = {
    {"culling", &Mechanisms::culling},
    {"skipping", &Mechanisms::skipping},
    {"termination", &Mechanisms::termination},
    {"lattice", &Mechanisms::lattice},
    {"sharing", &Mechanisms::sharing}};
inline constexpr std::pair<std::string_view, Place> places[] = {
    {"top-left", Place::top_left},   {"top", Place::top},
    {"top-right", Place::top_right}, {"left", Place::left},
    {"right", Place::right},         {"bottom-left", Place::bottom_left},
    {"bottom", Place::bottom},       {"bottom-right", Place::bottom_right}};

}  // namespace tessera::api
