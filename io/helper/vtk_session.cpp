#include "io/helper/vtk_session.hpp"

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

#include <cctype>
#include <mutex>
#include <new>
#include <stdexcept>
#include <vector>

#include "io/helper/readers.hpp"
#include "io/helper/serve.hpp"
#include "scene/error.hpp"

namespace tessera::io::helper {
namespace {

/// The first error and the first warning that VTK had to say, each on one line.
class MessageTrap : public vtkOutputWindow {
 public:
  static MessageTrap* New();
  vtkTypeMacro(MessageTrap, vtkOutputWindow);

  void DisplayText(const char*) override {}
  void DisplayErrorText(const char* text) override { keep(error, text); }
  void DisplayWarningText(const char* text) override { keep(warning, text); }
  void DisplayGenericWarningText(const char* text) override { keep(warning, text); }
  void DisplayDebugText(const char*) override {}

  std::string error, warning;
  std::vector<std::string> passed_over;

 private:
  /// VTK writes "ERROR: In /path/x.cxx, line 12\nvtkX (0x55..): message\n\n"; only the message is for users.
  void keep(std::string& first, const char* text) {
    if (!first.empty() || !text) return;
    std::string message = text;
    for (const std::string& words : passed_over)
      if (message.find(words) != std::string::npos) return;
    if (const std::size_t at = message.find("): "); at != std::string::npos) message.erase(0, at + 3);
    // Where the reader lies in memory says nothing to anybody, and another thing each time.
    for (std::size_t at = 0; (at = message.find("(0x", at)) != std::string::npos;) {
      const std::size_t end = message.find(')', at);
      if (end == std::string::npos) break;
      message.erase(at, end + 1 - at);
    }
    for (const unsigned char c : message) {
      const char plain = std::isprint(c) ? static_cast<char>(c) : ' ';
      if (plain != ' ' || (!first.empty() && first.back() != ' ')) first += plain;
    }
    while (!first.empty() && (first.back() == ' ' || first.back() == '.')) first.pop_back();
    if (first.size() > 200) first = first.substr(0, 200) + "...";
    if (first.empty()) first = "VTK reports an error";
  }
};
vtkStandardNewMacro(MessageTrap);

/// Installs the trap for as long as it lives.
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
    throw scene::bad_input(fmt::format("{}: it gives impossible sizes; {}", source, remedy));
  }
  // What a file that is cut short gives VTK's legacy reader to say is a warning to it.
  if (quiet.trap->error.empty() && quiet.trap->warning.find("Error reading") != std::string::npos)
    throw scene::bad_input(fmt::format("{}: it ends before its data do; {}", source, remedy));
  // Legacy files of fields alone.
  if (quiet.trap->error.find("did not create output") != std::string::npos)
    throw scene::bad_input(fmt::format("{}: it holds no points and cells; give the file that does", source));
  // Some readers begin with the file's name themselves.
  if (quiet.trap->error.starts_with(source + ": ")) quiet.trap->error.erase(0, source.size() + 2);
  if (!quiet.trap->error.empty()) throw scene::bad_input(fmt::format("{}: {}; {}", source, quiet.trap->error, remedy));
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
  reader.ReadAllScalarsOn();
  reader.ReadAllVectorsOn();
  reader.ReadAllNormalsOn();
  reader.ReadAllTensorsOn();
  reader.ReadAllColorScalarsOn();
  reader.ReadAllTCoordsOn();
  reader.ReadAllFieldsOn();
  reader.Update();
}

}  // namespace tessera::io::helper
