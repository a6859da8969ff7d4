// SPDX-License-Identifier: BSD-3-Clause
#include "readers/xdmf/xdmf_rewritten.hpp"

#include <fmt/format.h>
#include <libxml/parser.h>
#include <libxml/xpath.h>

#include <memory>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

#include "io/files/whole_file.hpp"
#include "readers/xdmf/xdmf_elements.hpp"
#include "readers/xdmf/xdmf_references.hpp"
#include "scene/error.hpp"
#include "tessera/program/text.hpp"

namespace tessera::readers {
namespace {

const xmlChar* xml(const char* text) { return reinterpret_cast<const xmlChar*>(text); }

/// Takes ownership of a string that libxml2 allocated, and returns a copy.
std::string taken(xmlChar* text) {
  if (text == nullptr) return "";
  std::string copy(reinterpret_cast<const char*>(text));
  xmlFree(text);
  return copy;
}

class Rewriting {
 public:
  Rewriting(xmlDoc* document, const std::string& source)
      : source_(source), context_(xmlXPathNewContext(document), xmlXPathFreeContext) {}

  void apply() {
    complete_attributes();
    complete_grids();
    complete_items();
    spread_times();
    for (xmlNode* node : all("//*[@href]")) xmlUnsetProp(node, xml("href"));  // references within this file
    include_references();
  }

 private:
  [[nodiscard]] std::vector<xmlNode*> all(const std::string& path, xmlNode* from = nullptr) {
    std::vector<xmlNode*> nodes;
    context_->node = from;
    xmlXPathObject* const found = xmlXPathEvalExpression(xml(path.c_str()), context_.get());
    if (found != nullptr && found->type == XPATH_NODESET && found->nodesetval != nullptr)
      for (int k = 0; k < found->nodesetval->nodeNr; ++k)
        if (found->nodesetval->nodeTab[k]->type == XML_ELEMENT_NODE) nodes.push_back(found->nodesetval->nodeTab[k]);
    if (found != nullptr) xmlXPathFreeObject(found);
    return nodes;
  }

  static std::optional<std::string> property(xmlNode* node, const char* name) {
    if (xmlHasProp(node, xml(name)) == nullptr) return std::nullopt;
    return taken(xmlGetProp(node, xml(name)));
  }
  static void set(xmlNode* node, const char* name, const std::string& value) {
    xmlSetProp(node, xml(name), xml(value.c_str()));
  }

  static const char* type_name(xmlNode* node, const char* name) { return property(node, name) ? name : "Type"; }

  void complete_attributes() {
    std::size_t number = 0;
    for (xmlNode* node : all("//Attribute[not(@Reference)]")) {
      if (!property(node, "Name")) set(node, "Name", fmt::format("attribute{}", number));
      if (!property(node, "Center")) set(node, "Center", "Node");
      if (property(node, "AttributeType") == "FiniteElementFunction")
        set(node, "AttributeType", "Scalar"), set(node, "ItemType", "FiniteElementFunction");
      ++number;
    }
  }

  void complete_grids() {
    for (xmlNode* node : all("//Topology[not(@Dimensions)][@NumberOfElements]"))
      if (is_structured(property(node, type_name(node, "TopologyType")).value_or("")))
        set(node, "Dimensions", *property(node, "NumberOfElements"));
    for (xmlNode* node : all("//Topology[@BaseOffset]")) {
      xmlNode* const noted = xmlNewChild(node, nullptr, xml("Information"), nullptr);
      set(noted, "Name", base_offset), set(noted, "Value", *property(node, base_offset));
    }
    for (xmlNode* node : all("//Geometry[not(@Reference)]")) {
      const char* const type = type_name(node, "GeometryType");
      if (!is_of_three_arrays(property(node, type).value_or(""))) continue;
      set(node, type, "XYZ");
      const std::vector<xmlNode*> items = all("DataItem", node);
      xmlNode* const joined = xmlNewChild(node, nullptr, xml("DataItem"), nullptr);
      set(joined, "ItemType", "Function"), set(joined, "Function", interleaved);
      for (xmlNode* item : items) xmlUnlinkNode(item), xmlAddChild(joined, item);
    }
  }

  void complete_selection(xmlNode* node) {
    set(node, "ItemType", "HyperSlab");
    const std::vector<xmlNode*> items = all("DataItem", node);
    if (items.empty()) return;
    xmlUnsetProp(items.front(), xml("DataType"));
    set(items.front(), "NumberType", "Int"), set(items.front(), "Precision", "8");  // otherwise floats, which round
  }

  void complete_items() {
    for (xmlNode* node : all("//DataItem[not(@Reference)]")) {
      const std::optional<std::string> format = property(node, "Format");
      if (!format || format == "xml") set(node, "Format", "XML");
      if (format == "HDF5" || format == "hdf") set(node, "Format", "HDF");
      if (format == "binary") set(node, "Format", "Binary");
      if (is_selection(property(node, "ItemType").value_or(""))) complete_selection(node);
      const char* const type = property(node, "NumberType") ? "NumberType" : "DataType";
      if (const auto name = library_type(property(node, type).value_or(""), property(node, "Precision").value_or("")))
        set(node, type, *name);
    }
  }

  /// Distributes the times of a collection to its grids. The times are given as a list, or as first time, step and
  /// count.
  void spread_times() {
    for (xmlNode* node : all("//Time[not(@Value)]")) {
      const std::string kind = property(node, "TimeType").value_or("");
      std::vector<double> times;
      for (xmlNode* item : all("DataItem", node)) {
        std::istringstream words(taken(xmlNodeGetContent(item)));
        for (double number = 0; words >> number;) times.push_back(number);
      }
      const std::vector<xmlNode*> grids = all("Grid", node->parent);
      if (kind == "HyperSlab" && times.size() == 3) {
        const double first = times[0], step = times[1];
        times.clear();
        for (std::size_t k = 0; k < grids.size(); ++k) times.push_back(first + static_cast<double>(k) * step);
      }
      for (std::size_t k = 0; k < grids.size() && times.size() == grids.size() && kind != "Range"; ++k)
        if (all("Time", grids[k]).empty()) {
          xmlNode* const time = xmlNewChild(grids[k], nullptr, xml("Time"), nullptr);
          set(time, "Value", fmt::format("{}", times[k]));
        }
      xmlUnlinkNode(node), xmlFreeNode(node);
    }
  }

  /// Returns the target of a reference, which may itself be a reference.
  xmlNode* target_of(xmlNode* node) {
    constexpr int most = 16;
    xmlNode* target = node;
    for (int k = 0; k < most; ++k) {
      std::string path = property(target, "Reference").value_or("");
      if (path == "XML") path = std::string(trimmed(taken(xmlNodeGetContent(target))));
      const std::vector<xmlNode*> found = path.empty() ? std::vector<xmlNode*>() : all(path, target);
      const std::string name(reinterpret_cast<const char*>(node->name));
      if (found.empty() || name != reinterpret_cast<const char*>(found.front()->name))
        throw scene::bad_input(fmt::format("{}: a <{}> refers by Reference to {}, which does not exist; {}", source_,
                                           name, quote(path), remedy));
      target = found.front();
      if (!property(target, "Reference")) break;
    }
    for (const xmlNode* outer = node; outer != nullptr; outer = outer->parent)
      if (outer == target || property(target, "Reference"))
        throw scene::bad_input(fmt::format("{}: a <{}> refers by Reference to itself; {}", source_,
                                           reinterpret_cast<const char*>(node->name), remedy));
    return target;
  }

  void include_references() {
    const std::vector<xmlNode*> references = all("//*[@Reference]");
    std::vector<xmlNode*> targets, includes;
    for (xmlNode* node : references) targets.push_back(target_of(node));
    for (xmlNode* node : references) {
      includes.push_back(xmlNewNode(nullptr, xml("include")));
      xmlReplaceNode(node, includes.back());
    }
    // The paths of nodes do not change after the replacement of all references, so they are computed here.
    for (std::size_t k = 0; k < includes.size(); ++k)
      set(includes[k], "xpointer", fmt::format("xpointer({})", taken(xmlGetNodePath(targets[k]))));
    for (xmlNode* node : references) xmlFreeNode(node);
  }

  static constexpr const char* remedy = "write the element itself there, or save the file as .vtu in ParaView";

  const std::string& source_;
  std::unique_ptr<xmlXPathContext, void (*)(xmlXPathContext*)> context_;
};

}  // namespace

std::string rewritten_xdmf(const std::filesystem::path& file) {
  const std::string source = file.string();
  xmlSetStructuredErrorFunc(nullptr, [](void*, xmlErrorPtr) {});  // otherwise libxml2 writes to stderr
  const io::WholeFile mapped(file);
  const std::string_view text = mapped.text();
  const std::unique_ptr<xmlDoc, void (*)(xmlDoc*)> document(
      xmlReadMemory(text.data(), static_cast<int>(text.size()), nullptr, nullptr,
                    XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING | XML_PARSE_HUGE),
      xmlFreeDoc);
  if (document == nullptr)
    throw scene::bad_input(fmt::format("{}: it is not well-formed XML; write the file again", source));
  Rewriting(document.get(), source).apply();
  xmlChar* dumped = nullptr;
  int size = 0;
  xmlDocDumpMemory(document.get(), &dumped, &size);
  if (dumped == nullptr) throw std::bad_alloc();
  return taken(dumped);
}

CurrentFolder::CurrentFolder(const std::filesystem::path& folder) {
  if (folder.empty()) return;
  before_ = std::filesystem::current_path();
  std::filesystem::current_path(folder);
}

CurrentFolder::~CurrentFolder() {
  std::error_code ignored;
  if (!before_.empty()) std::filesystem::current_path(before_, ignored);
}

}  // namespace tessera::readers
