// TestCertificates: authorities and certificates made by openssl for one test, in files that end with it.

#ifndef RICOCHET_TESTS_SUPPORT_PROCESSES_TEST_CERTIFICATES_H_
#define RICOCHET_TESTS_SUPPORT_PROCESSES_TEST_CERTIFICATES_H_

#include <string>

#include "tests/support/processes/temporary_directory.h"

namespace ricochet {

class TestCertificates {
 public:
  // Makes the authority "ca". Throws std::runtime_error if openssl fails.
  TestCertificates();
  TestCertificates(const TestCertificates&) = delete;
  TestCertificates& operator=(const TestCertificates&) = delete;

  // Makes another authority: NAME.pem and NAME.key.
  void MakeAuthority(const std::string& name);

  // Makes NAME.pem and NAME.key: a certificate for the DNS name `host`, issued by an authority for `days` from now on.
  // A negative number means that it has ended. `key` is an algorithm as `openssl req -newkey` takes it.
  void Make(const std::string& name, const std::string& host, const std::string& authority = "ca", int days = 1,
            const std::string& key = "ec -pkeyopt ec_paramgen_curve:prime256v1");

  // Makes the files of `name` those of `other`, each in one step.
  void Replace(const std::string& name, const std::string& other) const;

  // Writes a file.
  void Write(const std::string& file, const std::string& text) const;

  // Returns the path of a file.
  std::string operator/(const std::string& file) const { return directory_ / file; }

 private:
  void Run(const std::string& arguments) const;

  TemporaryDirectory directory_;
};

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_PROCESSES_TEST_CERTIFICATES_H_
