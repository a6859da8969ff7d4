// DICOM series, read by a helper of their own.
#include "io/foreign_grids.hpp"
#include "io/volume_formats.hpp"

namespace tessera::io {

bool has_dicom() { return true; }

VolumeFile read_dicom(const std::filesystem::path& file, const VolumeOptions& options) {
  nlohmann::json request{{"reader", "dicom"}};
  if (options.time_step) request["time_step"] = *options.time_step;
  HelperTask task;
  task.program = "tessera-read-dicom";
  return grid_of(open_foreign(std::make_shared<HelperProcess>(std::move(task)), file, std::move(request)), options);
}

}  // namespace tessera::io
