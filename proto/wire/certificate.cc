#include "proto/wire/certificate.h"

#include "proto/wire/outcome.h"

namespace ricochet {

static v1::CertifiedNumber ToProto(const CertifiedNumber& number) {
  v1::CertifiedNumber proto;
  proto.set_path(number.path);
  proto.set_decimal(number.decimal);
  proto.set_lower(number.lower);
  proto.set_upper(number.upper);
  proto.set_value(number.value);
  proto.set_exact(number.exact);
  return proto;
}

static CertifiedNumber FromProto(const v1::CertifiedNumber& proto) {
  return {.path = proto.path(),
          .decimal = proto.decimal(),
          .lower = proto.lower(),
          .upper = proto.upper(),
          .value = proto.value(),
          .exact = proto.exact()};
}

v1::Certificate ToProto(const Certificate& certificate) {
  v1::Certificate proto;
  proto.set_digits(certificate.digits);
  proto.set_precision_bits(certificate.precision_bits);
  for (const Regime regime : certificate.regimes) proto.add_regimes(ToProto(regime));
  proto.set_is_set(certificate.is_set);
  for (const CertifiedNumber& number : certificate.numbers) *proto.add_numbers() = ToProto(number);
  return proto;
}

Certificate FromProto(const v1::Certificate& proto) {
  Certificate certificate = {.digits = proto.digits(), .precision_bits = proto.precision_bits()};
  for (const int regime : proto.regimes()) certificate.regimes.push_back(FromProto(static_cast<v1::Regime>(regime)));
  certificate.is_set = proto.is_set();
  for (const v1::CertifiedNumber& number : proto.numbers()) certificate.numbers.push_back(FromProto(number));
  return certificate;
}

}  // namespace ricochet
