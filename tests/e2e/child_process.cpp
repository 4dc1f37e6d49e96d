#include "tests/e2e/child_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace roadfix::testing {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

[[noreturn]] void become(const std::string& program, const std::vector<std::string>& arguments, const std::string& out,
                         const std::string& err) {
  constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC;
  dup2(open(out.c_str(), kFlags, 0644), STDOUT_FILENO);
  dup2(open(err.c_str(), kFlags, 0644), STDERR_FILENO);
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  execv(program.c_str(), argv.data());
  _exit(127);
}

}  // namespace

ChildResult run_child(const std::string& program, const std::vector<std::string>& arguments,
                      const std::filesystem::path& folder, std::chrono::microseconds kill_after, int signal) {
  const std::string out = folder / "stdout";
  const std::string err = folder / "stderr";
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) become(program, arguments, out, err);
  if (kill_after.count() > 0) {
    std::this_thread::sleep_for(kill_after);
    kill(child, signal);
  }
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  ChildResult result;
  result.killed = WIFSIGNALED(status);
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  result.out = text_of(out);
  result.err = text_of(err);
  result.peak_memory_kib = usage.ru_maxrss;
  return result;
}

}  // namespace roadfix::testing
