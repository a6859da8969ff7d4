// SPDX-License-Identifier: BSD-3-Clause
#include <expat.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>

#include "io/scene/camera_file.hpp"
#include "io/scene/camera_words.hpp"
#include "io/text/text_file.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

using namespace std::string_view_literals;

/// State of the callbacks. They are called from C, so they must not throw: the first error is stored and the parser
/// stopped.
struct Pvcc {
  XML_Parser parser = nullptr;
  bool root_seen = false;
  std::string property;                                                ///< name of the open <Property>
  std::map<std::string, std::array<std::optional<double>, 3>> values;  ///< values of the properties that a camera needs
  std::string fault;

  void stop(std::string what) {
    if (fault.empty()) fault = std::move(what);
    XML_StopParser(parser, XML_FALSE);
  }
};

constexpr std::array wanted{"CameraPosition"sv,      "CameraFocalPoint"sv, "CameraViewUp"sv,
                            "CameraParallelScale"sv, "CameraViewAngle"sv,  "CameraParallelProjection"sv};

const char* attribute(const XML_Char** attributes, std::string_view name) {
  for (; *attributes != nullptr; attributes += 2)
    if (attributes[0] == name) return attributes[1];
  return nullptr;
}

void XMLCALL on_start(void* user, const XML_Char* element, const XML_Char** attributes) {
  Pvcc& pvcc = *static_cast<Pvcc*>(user);
  try {
    if (!pvcc.root_seen) {
      if (element != "PVCameraConfiguration"sv)
        return pvcc.stop(
            fmt::format("the XML begins with {}, not PVCameraConfiguration; save the camera in ParaView "
                        "as .pvcc",
                        quote(element)));
      pvcc.root_seen = true;
    } else if (element == "Property"sv) {
      const char* name = attribute(attributes, "name");
      pvcc.property = name == nullptr ? "" : name;
      if (std::ranges::find(wanted, pvcc.property) == wanted.end()) {
        pvcc.property.clear();
      } else if (!pvcc.values.try_emplace(pvcc.property).second) {
        pvcc.stop(pvcc.property + " is given twice; keep one");
      }
    } else if (element == "Element"sv && !pvcc.property.empty()) {
      const char *index = attribute(attributes, "index"), *value = attribute(attributes, "value");
      const auto number = value == nullptr ? std::nullopt : parse_number(value);
      if (!number)
        return pvcc.stop(fmt::format("{} has the value {}, which is not a finite number; save the camera again",
                                     pvcc.property, quote(value == nullptr ? "" : value)));
      if (index == nullptr || index[0] < '0' || index[0] > '2' || index[1] != '\0')
        return pvcc.stop(fmt::format("{} has the element index {}; it must be 0, 1 or 2", pvcc.property,
                                     quote(index == nullptr ? "" : index)));
      auto& slot = pvcc.values[pvcc.property][static_cast<std::size_t>(index[0] - '0')];
      if (slot) return pvcc.stop(fmt::format("{} has element {} twice; keep one", pvcc.property, index));
      slot = number;
    }
  } catch (const std::exception& error) {
    pvcc.stop(error.what());
  }
}

void XMLCALL on_end(void* user, const XML_Char* element) {
  if (element == "Property"sv) static_cast<Pvcc*>(user)->property.clear();
}

void XMLCALL on_doctype(void* user, const XML_Char*, const XML_Char*, const XML_Char*, int) {
  // Entities can expand a small file without bound, and ParaView's cameras do not contain them.
  static_cast<Pvcc*>(user)->stop("has a DOCTYPE; a ParaView camera has none, save it again");
}

}  // namespace

CameraFile parse_pvcc_camera(std::string_view text, const std::string& source) {
  const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(XML_ParserCreate(nullptr), &XML_ParserFree);
  if (!parser) throw scene::Error(scene::ErrorCode::system_failure, source + ": no memory for the XML parser");
  Pvcc pvcc;
  pvcc.parser = parser.get();
  XML_SetUserData(parser.get(), &pvcc);
  XML_SetElementHandler(parser.get(), on_start, on_end);
  XML_SetStartDoctypeDeclHandler(parser.get(), on_doctype);
  // The limit of read_text_file() ensures that the size fits into an int.
  const XML_Status status = XML_Parse(parser.get(), text.data(), static_cast<int>(text.size()), 1);
  const auto line = XML_GetCurrentLineNumber(parser.get());
  if (!pvcc.fault.empty()) throw scene::bad_input(fmt::format("{}: line {}: {}", source, line, pvcc.fault));
  if (status != XML_STATUS_OK)
    throw scene::bad_input(fmt::format("{}: line {}: not valid XML ({}); save the camera again", source, line,
                                       XML_ErrorString(XML_GetErrorCode(parser.get()))));

  CameraWords words(source);
  const auto pass_on = [&](const char* property, const char* word, std::size_t count, bool required) {
    const auto found = pvcc.values.find(property);
    if (found == pvcc.values.end()) {
      if (required) throw scene::bad_input(fmt::format("{}: {} is missing; save the camera again", source, property));
      return;
    }
    std::vector<double> numbers;
    for (const auto& value : found->second)
      if (value) numbers.push_back(*value);
    if (numbers.size() != count)
      throw scene::bad_input(
          fmt::format("{}: {} has {} of {} numbers; save the camera again", source, property, numbers.size(), count));
    words.set(word, numbers, source);
  };
  pass_on("CameraPosition", "position", 3, true);
  pass_on("CameraFocalPoint", "focal_point", 3, true);
  pass_on("CameraViewUp", "view_up", 3, false);
  const auto parallel = pvcc.values.find("CameraParallelProjection");
  if (parallel != pvcc.values.end() && parallel->second[0].value_or(0) != 0)
    pass_on("CameraParallelScale", "parallel_scale", 1, true);
  else
    pass_on("CameraViewAngle", "view_angle", 1, true);
  return words.finish();
}

}  // namespace tessera::io
