#include "io/chrome_trace.hpp"

#include <nlohmann/json.hpp>
#include <set>

#include "io/atomic_file.hpp"

namespace tessera::io {

std::string chrome_trace_json(const scene::Trace& trace, int rank, const std::string& process_name) {
  using nlohmann::ordered_json;
  ordered_json events = ordered_json::array();
  events.push_back(
      {{"name", "process_name"}, {"ph", "M"}, {"pid", rank}, {"tid", 0}, {"args", {{"name", process_name}}}});
  const std::vector<scene::TraceSpan> spans = trace.spans();
  std::set<std::uint32_t> threads;
  for (const scene::TraceSpan& span : spans) threads.insert(span.thread);
  for (const std::uint32_t thread : threads)
    events.push_back({{"name", "thread_name"},
                      {"ph", "M"},
                      {"pid", rank},
                      {"tid", thread},
                      {"args", {{"name", "thread " + std::to_string(thread)}}}});
  for (const scene::TraceSpan& span : spans)
    events.push_back({{"name", span.stage},
                      {"cat", "tessera"},
                      {"ph", "X"},
                      {"pid", rank},
                      {"tid", span.thread},
                      {"ts", span.start_us},
                      {"dur", span.wall_us},
                      {"args", {{"cpu_us", span.cpu_us}}}});
  const ordered_json whole{{"displayTimeUnit", "ms"}, {"traceEvents", std::move(events)}};
  // `replace`: a process name that is not UTF-8 must not cost the trace.
  return whole.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

void write_chrome_trace(const scene::Trace& trace, const std::filesystem::path& file, int rank,
                        const std::string& process_name) {
  AtomicFile output(file);
  output.write(chrome_trace_json(trace, rank, process_name));
  output.commit();
}

}  // namespace tessera::io
