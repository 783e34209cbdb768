// Silence: the standard output goes to /dev/null while it lives, because an engine describes its steps there.

#ifndef RICOCHET_TESTS_PEERS_SILENCE_H_
#define RICOCHET_TESTS_PEERS_SILENCE_H_

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <iostream>

namespace ricochet::peers {

class Silence {
 public:
  Silence() : output_(dup(STDOUT_FILENO)) {
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    close(nowhere);
  }
  ~Silence() {
    std::cout.flush();
    std::fflush(stdout);
    dup2(output_, STDOUT_FILENO);
    close(output_);
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  const int output_;
};

}  // namespace ricochet::peers

#endif  // RICOCHET_TESTS_PEERS_SILENCE_H_
