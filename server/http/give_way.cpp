#include "server/http/give_way.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <future>
#include <optional>
#include <system_error>

namespace roadfix::http {
namespace {

constexpr int kNicer = 10;  // gets a tenth of a processor that a thread of the process's own priority wants, too

/// Threads that this one starts have its priority. It cannot be raised again.
void lower_priority() {
  const auto thread = static_cast<id_t>(gettid());
  setpriority(PRIO_PROCESS, thread, getpriority(PRIO_PROCESS, thread) + kNicer);
}

std::optional<std::future<Response>> started(const std::function<Response()>& work) {
  try {
    return std::async(std::launch::async, [&work] {
      lower_priority();
      return work();
    });
  } catch (const std::system_error&) {
    return std::nullopt;
  }
}

}  // namespace

Response giving_way(const std::function<Response()>& work) {
  std::optional<std::future<Response>> answer = started(work);
  return answer ? answer->get() : work();
}

}  // namespace roadfix::http
