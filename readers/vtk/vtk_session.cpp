// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/vtk_session.hpp"

#include <fmt/format.h>
#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkDataSetReader.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

#include <limits>
#include <mutex>
#include <new>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "readers/common/readers.hpp"
#include "readers/common/serve.hpp"
#include "readers/vtk/odd_numbers.hpp"
#include "readers/vtk/vtk_words.hpp"
#include "scene/error.hpp"

namespace tessera::readers {
namespace {

/// The first error and the first warning that VTK reports, each on one line.
class MessageTrap : public vtkOutputWindow {
 public:
  static MessageTrap* New();
  vtkTypeMacro(MessageTrap, vtkOutputWindow);

  void DisplayText(const char*) override {}
  void DisplayErrorText(const char* text) override {
    if (keep(error, text)) failed = true;
  }
  void DisplayWarningText(const char* text) override { keep(warning, text); }
  void DisplayGenericWarningText(const char* text) override { keep(warning, text); }
  void DisplayDebugText(const char*) override {}

  std::string error, warning;
  bool failed = false;  ///< an error was reported, perhaps without a message
  std::vector<std::string> passed_over;

 private:
  /// Keeps a message if it is the first. VTK writes "ERROR: In /path/x.cxx, line 12\nvtkX (0x55..): message\n\n"; only
  /// the message is for users.
  bool keep(std::string& first, const char* text) {
    if (!first.empty() || text == nullptr) return false;
    for (const std::string& words : passed_over)
      if (std::string_view(text).find(words) != std::string_view::npos) return false;
    first = words_for_users(text);
    return true;
  }
};
vtkStandardNewMacro(MessageTrap);

/// Installs the trap during the lifetime of this object.
class Quiet {
 public:
  Quiet()
      : lock_(mutex()), before_(vtkOutputWindow::GetInstance()), verbosity_(vtkLogger::GetCurrentVerbosityCutoff()) {
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
    vtkOutputWindow::SetInstance(trap);
  }
  ~Quiet() {
    vtkOutputWindow::SetInstance(before_);
    vtkLogger::SetStderrVerbosity(verbosity_);
  }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

  vtkSmartPointer<MessageTrap> trap = vtkSmartPointer<MessageTrap>::New();

 private:
  static std::mutex& mutex() {
    static std::mutex one_at_a_time;
    return one_at_a_time;
  }
  std::lock_guard<std::mutex> lock_;
  vtkSmartPointer<vtkOutputWindow> before_;
  vtkLogger::Verbosity verbosity_;
};

}  // namespace

std::string with_quiet_vtk(const std::string& source, const std::string& remedy, const std::function<void()>& work,
                           std::initializer_list<const char*> passed_over) {
  const Quiet quiet;
  quiet.trap->passed_over.assign(passed_over.begin(), passed_over.end());
  try {
    work();
  } catch (const std::bad_alloc&) {
    throw memory_error(source);
  } catch (const std::length_error&) {
    throw scene::bad_input(fmt::format("{}: it states impossible sizes; {}", source, remedy));
  }
  if (!quiet.trap->failed && quiet.trap->warning.find("Error reading") != std::string::npos)
    throw error_of_vtk(source, "it ends before its data do", remedy);
  if (quiet.trap->failed) throw error_of_vtk(source, quiet.trap->error, remedy);
  return quiet.trap->warning;
}

void watch_progress(vtkAlgorithm& reader) {
  const vtkNew<vtkCallbackCommand> observer;
  observer->SetCallback([](vtkObject* caller, unsigned long, void*, void*) {
    if (auto* algorithm = vtkAlgorithm::SafeDownCast(caller)) report_progress(algorithm->GetProgress());
  });
  reader.AddObserver(vtkCommand::ProgressEvent, observer);
}

void read_all_arrays(vtkDataSetReader& reader, const std::string& source) {
  watch_progress(reader);
  reader.SetFileName(source.c_str());
  const OddNumbers odd(source);
  if (odd.any()) {
    if (odd.text().size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) throw std::bad_alloc();
    reader.ReadFromInputStringOn();
    reader.SetBinaryInputString(odd.text().data(), static_cast<int>(odd.text().size()));
  }
  reader.ReadAllScalarsOn();
  reader.ReadAllVectorsOn();
  reader.ReadAllNormalsOn();
  reader.ReadAllTensorsOn();
  reader.ReadAllColorScalarsOn();
  reader.ReadAllTCoordsOn();
  reader.ReadAllFieldsOn();
  reader.Update();
  odd.restore(reader.GetOutputDataObject(0));
}

}  // namespace tessera::readers
