// The real `roadfix serve` in a process of its own, on a free port.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace roadfix::testing {

class ServiceProcess {
 public:
  /// Starts it and waits until it has printed its address. `options` come after --maps and --port; 0 = any free one.
  /// The detector is the tree, if they name no other. However the thread that calls this ends, the service ends with
  /// it.
  explicit ServiceProcess(const std::filesystem::path& maps, const std::vector<std::string>& options = {},
                          int port = 0);
  /// Kills it if it still runs.
  ~ServiceProcess();
  ServiceProcess(const ServiceProcess&) = delete;
  ServiceProcess& operator=(const ServiceProcess&) = delete;

  int port() const { return port_; }
  pid_t id() const { return process_; }
  void send_signal(int signal) const;
  /// Exit status as waitpid gives it, -1 if it did not end in time.
  int wait(std::chrono::milliseconds time = std::chrono::seconds(30));

 private:
  pid_t process_ = -1;
  int port_ = 0;
};

}  // namespace roadfix::testing
