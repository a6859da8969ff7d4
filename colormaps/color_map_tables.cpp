// SPDX-License-Identifier: BSD-3-Clause
#include "colormaps/color_map_tables.hpp"

#include <array>

namespace tessera::colormaps {
namespace {

using glm::dvec3;

// The published tables of 256 entries, sampled at 17 equal distances; linear interpolation of display values stays
// within 0.025 of the published tables.

// Smith, van der Walt, Firing: "A Better Default Colormap for Matplotlib", 2015; released as CC0.
constexpr std::array<dvec3, 17> viridis{{{0.267, 0.0049, 0.3294},
                                         {0.2823, 0.0946, 0.417},
                                         {0.2789, 0.1749, 0.483},
                                         {0.2593, 0.2507, 0.5244},
                                         {0.2302, 0.3213, 0.5455},
                                         {0.2, 0.3864, 0.5545},
                                         {0.1733, 0.4474, 0.5579},
                                         {0.1497, 0.5064, 0.5573},
                                         {0.1281, 0.5651, 0.5509},
                                         {0.1203, 0.6238, 0.5343},
                                         {0.1554, 0.6815, 0.5032},
                                         {0.2415, 0.7366, 0.4545},
                                         {0.3629, 0.7867, 0.3866},
                                         {0.5081, 0.8292, 0.2992},
                                         {0.6694, 0.8622, 0.1954},
                                         {0.8359, 0.8861, 0.1025},
                                         {0.9932, 0.9062, 0.1439}}};
constexpr std::array<dvec3, 17> plasma{{{0.0504, 0.0298, 0.528},
                                        {0.1929, 0.0184, 0.5901},
                                        {0.2991, 0.0096, 0.6314},
                                        {0.3983, 0.0009, 0.656},
                                        {0.4934, 0.0115, 0.658},
                                        {0.5827, 0.0672, 0.6335},
                                        {0.6633, 0.1369, 0.5869},
                                        {0.7342, 0.2075, 0.5295},
                                        {0.7964, 0.278, 0.4713},
                                        {0.8515, 0.349, 0.4157},
                                        {0.9, 0.4222, 0.3618},
                                        {0.941, 0.4992, 0.3081},
                                        {0.9722, 0.5817, 0.2541},
                                        {0.9908, 0.6706, 0.201},
                                        {0.9934, 0.7663, 0.1566},
                                        {0.9762, 0.8684, 0.1434},
                                        {0.94, 0.9752, 0.1313}}};
constexpr std::array<dvec3, 17> inferno{{{0.0015, 0.0005, 0.0139},
                                         {0.042, 0.028, 0.1406},
                                         {0.1285, 0.0473, 0.2896},
                                         {0.237, 0.0366, 0.3956},
                                         {0.3399, 0.0618, 0.4292},
                                         {0.4393, 0.0986, 0.4317},
                                         {0.5386, 0.1339, 0.4157},
                                         {0.6375, 0.1704, 0.3822},
                                         {0.7328, 0.2143, 0.3321},
                                         {0.8195, 0.2728, 0.2685},
                                         {0.8918, 0.35, 0.1965},
                                         {0.9451, 0.4448, 0.1188},
                                         {0.9774, 0.5526, 0.038},
                                         {0.9879, 0.6692, 0.0596},
                                         {0.9759, 0.7909, 0.1973},
                                         {0.9486, 0.9109, 0.3963},
                                         {0.9884, 0.9984, 0.6449}}};
constexpr std::array<dvec3, 17> magma{{{0.0015, 0.0005, 0.0139},
                                       {0.0394, 0.0309, 0.133},
                                       {0.1124, 0.0653, 0.2756},
                                       {0.2104, 0.0622, 0.4173},
                                       {0.3151, 0.0712, 0.4848},
                                       {0.4128, 0.1096, 0.5045},
                                       {0.5105, 0.1473, 0.5077},
                                       {0.6108, 0.1809, 0.499},
                                       {0.7132, 0.2139, 0.4762},
                                       {0.8135, 0.2542, 0.4381},
                                       {0.9013, 0.3165, 0.3899},
                                       {0.9592, 0.4135, 0.3599},
                                       {0.9859, 0.53, 0.3801},
                                       {0.9959, 0.6477, 0.4423},
                                       {0.997, 0.7633, 0.5296},
                                       {0.9928, 0.8776, 0.6335},
                                       {0.9871, 0.9914, 0.7495}}};

// Nunez, Anderton, Renslow: "Optimizing colormaps with consideration for color vision deficiency to enable accurate
// interpretation of scientific data", PLOS ONE, 2018.
constexpr std::array<dvec3, 17> cividis{{{0, 0.1262, 0.3015},
                                         {0, 0.1712, 0.4098},
                                         {0.0213, 0.2126, 0.4315},
                                         {0.1741, 0.2578, 0.4225},
                                         {0.2545, 0.3025, 0.4201},
                                         {0.3197, 0.3472, 0.4243},
                                         {0.3785, 0.3922, 0.4343},
                                         {0.4339, 0.4378, 0.4503},
                                         {0.4879, 0.4841, 0.471},
                                         {0.5481, 0.5321, 0.4736},
                                         {0.6104, 0.5815, 0.4677},
                                         {0.6745, 0.6325, 0.455},
                                         {0.7402, 0.6852, 0.4348},
                                         {0.8078, 0.7399, 0.4066},
                                         {0.8775, 0.7966, 0.3681},
                                         {0.9493, 0.8558, 0.3153},
                                         {1, 0.9169, 0.2731}}};

// Mikhailov: "Turbo, An Improved Rainbow Colormap for Visualization", Google AI blog, 2019.
constexpr std::array<dvec3, 17> turbo{{{0.19, 0.0718, 0.2322},
                                       {0.2509, 0.2517, 0.6324},
                                       {0.2762, 0.4199, 0.8897},
                                       {0.2594, 0.5777, 0.9986},
                                       {0.1602, 0.7332, 0.9252},
                                       {0.0927, 0.8634, 0.7655},
                                       {0.1922, 0.9474, 0.5993},
                                       {0.421, 0.9935, 0.3912},
                                       {0.6384, 0.991, 0.2365},
                                       {0.7994, 0.9277, 0.2042},
                                       {0.929, 0.8173, 0.2261},
                                       {0.9921, 0.681, 0.2059},
                                       {0.9853, 0.5018, 0.1324},
                                       {0.9253, 0.3229, 0.0577},
                                       {0.823, 0.1909, 0.0195},
                                       {0.6747, 0.0895, 0.0045},
                                       {0.4796, 0.0158, 0.0106}}};

// Moreland: "Diverging Color Maps for Scientific Visualization", ISVC 2009: only the ends; the colours between them are
// computed.
constexpr std::array<dvec3, 2> cool_warm{{{0.230, 0.299, 0.754}, {0.706, 0.016, 0.150}}};

// Hues of a glowing black body at uniformly increasing lightness, black to white, mixed in L*a*b*.
constexpr std::array<dvec3, 5> black_body{
    {{0, 0, 0}, {0.54, 0.09, 0.09}, {0.88, 0.36, 0.03}, {0.92, 0.80, 0.23}, {1, 1, 1}}};

constexpr std::array<dvec3, 2> gray{{{0, 0, 0}, {1, 1, 1}}};

// Shows only density, like fog or an inverted radiograph.
constexpr std::array<dvec3, 1> white{{{1, 1, 1}}};

constexpr ColorMapTable tables[] = {
    {"cool-warm", ColorSpace::diverging, cool_warm},
    {"viridis", ColorSpace::rgb, viridis},
    {"plasma", ColorSpace::rgb, plasma},
    {"inferno", ColorSpace::rgb, inferno},
    {"magma", ColorSpace::rgb, magma},
    {"cividis", ColorSpace::rgb, cividis},
    {"turbo", ColorSpace::rgb, turbo},
    {"black-body", ColorSpace::lab, black_body},
    {"gray", ColorSpace::lab, gray},
    {"white", ColorSpace::rgb, white},
};

}  // namespace

std::span<const ColorMapTable> color_map_tables() { return tables; }

}  // namespace tessera::colormaps
