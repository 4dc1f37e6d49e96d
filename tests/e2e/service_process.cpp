#include "tests/e2e/service_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <thread>

namespace roadfix::testing {
namespace {

std::string first_line(int pipe) {
  std::string line;
  char c = 0;
  while (::read(pipe, &c, 1) == 1 && c != '\n') line.push_back(c);
  return line;
}

[[noreturn]] void become_service(const std::vector<std::string>& arguments, int output, pid_t test) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != test) ::_exit(127);  // it died before it could be heard of
  std::vector<char*> raw;
  for (const std::string& argument : arguments) raw.push_back(const_cast<char*>(argument.c_str()));
  raw.push_back(nullptr);
  ::dup2(output, STDOUT_FILENO);
  ::execv(raw[0], raw.data());
  ::_exit(127);
}

}  // namespace

ServiceProcess::ServiceProcess(const std::filesystem::path& maps, const std::vector<std::string>& options, int port) {
  std::vector<std::string> arguments{ROADFIX_PROGRAM,      "serve",   "--maps", maps.string(), "--port",
                                     std::to_string(port), "--watch", "0.05",   "--log-level", "warn"};
  if (!std::ranges::count(options, "--detector")) arguments.insert(arguments.end(), {"--detector", "tree"});
  arguments.insert(arguments.end(), options.begin(), options.end());
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  const pid_t test = ::getpid();
  process_ = ::fork();
  if (process_ == 0) become_service(arguments, pipe[1], test);
  ::close(pipe[1]);
  const std::string line = first_line(pipe[0]);
  ::close(pipe[0]);
  const std::size_t colon = line.rfind(':');
  if (colon == std::string::npos) throw std::runtime_error("the service did not say where it is: " + line);
  port_ = std::atoi(line.c_str() + colon + 1);
}

ServiceProcess::~ServiceProcess() {
  if (process_ <= 0) return;
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
}

void ServiceProcess::send_signal(int signal) const { ::kill(process_, signal); }

int ServiceProcess::wait(std::chrono::milliseconds time) {
  const auto until = std::chrono::steady_clock::now() + time;
  int status = 0;
  while (std::chrono::steady_clock::now() < until) {
    if (::waitpid(process_, &status, WNOHANG) == process_) {
      process_ = -1;
      return status;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return -1;
}

}  // namespace roadfix::testing
