#include "frame/volume_frames.hpp"

namespace tessera::frame {

std::optional<FinishedVolumeFrame> VolumeFrames::render(volume::Renderer& renderer,
                                                        const scene::TransferFunction& function, const VolumeJob& job,
                                                        std::size_t number, scene::FrameWatch* watch) {
  scene::FrameWatch nobody;
  if (watch == nullptr) watch = &nobody;
  StopRelay::Run relayed(relay_, watch->stop());
  // What the caller's function throws stops all ranks in order before the caller gets it.
  std::exception_ptr thrown;
  scene::FrameWatch here(relayed.token());
  if (watch->wants_tiles() && transport_.rank() == 0)
    here.listen([&](const scene::PixelRect& rect, const scene::Image& image) {
      try {
        watch->finished(rect, image);
      } catch (...) {
        thrown = std::current_exception();
        relayed.stop();
        throw scene::FrameStopped();
      }
    });
  auto finished = make(renderer, function, job, number, here);
  if (thrown) std::rethrow_exception(thrown);
  return finished;
}

}  // namespace tessera::frame
