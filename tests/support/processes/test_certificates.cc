#include "tests/support/processes/test_certificates.h"

#include <cstdlib>
#include <fstream>
#include <stdexcept>

namespace ricochet {
namespace {

constexpr char kNewKey[] = "-newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes";

}  // namespace

TestCertificates::TestCertificates() { MakeAuthority("ca"); }

void TestCertificates::Run(const std::string& arguments) const {
  const std::string command = "cd '" + directory_.path().string() + "' && openssl " + arguments + " >>log 2>&1";
  if (std::system(command.c_str()) != 0) throw std::runtime_error(command);
}

void TestCertificates::MakeAuthority(const std::string& name) {
  Run(std::string("req -x509 ") + kNewKey + " -days 2 -subj /CN=" + name + " -keyout " + name + ".key -out " + name +
      ".pem");
}

void TestCertificates::Make(const std::string& name, const std::string& host, const std::string& authority, int days,
                            const std::string& key) {
  Run("req -new -newkey " + key + " -nodes -subj /CN=" + host + " -addext subjectAltName=DNS:" + host + " -keyout " +
      name + ".key -out " + name + ".csr");
  Run("x509 -req -in " + name + ".csr -CA " + authority + ".pem -CAkey " + authority +
      ".key -CAcreateserial -copy_extensions copy -days " + std::to_string(days) + " -out " + name + ".pem");
}

void TestCertificates::Replace(const std::string& name, const std::string& other) const {
  for (const char* suffix : {".key", ".pem"}) {
    const std::string copy = directory_ / (other + suffix + ".copy");
    std::filesystem::copy_file(directory_ / (other + suffix), copy);
    std::filesystem::rename(copy, directory_ / (name + suffix));
  }
}

void TestCertificates::Write(const std::string& file, const std::string& text) const {
  std::ofstream(directory_ / file) << text;
}

}  // namespace ricochet
