#include "proto/wire/certificate.h"

#include "proto/wire/map.h"
#include "proto/wire/outcome.h"

namespace ricochet {

template <>
struct Map<CertifiedNumber> : Between<CertifiedNumber, v1::CertifiedNumber> {
  using Fields =
      Entries<Entry(&T::path, &P::path, &P::mutable_path), Entry(&T::decimal, &P::decimal, &P::mutable_decimal),
              Entry(&T::lower, &P::lower, &P::mutable_lower), Entry(&T::upper, &P::upper, &P::mutable_upper),
              Entry(&T::value, &P::value, &P::set_value), Entry(&T::exact, &P::exact, &P::set_exact)>;
};

template <>
struct Map<Certificate> : Between<Certificate, v1::Certificate> {
  using Fields =
      Entries<Entry(&T::digits, &P::digits, &P::set_digits),
              Entry(&T::precision_bits, &P::precision_bits, &P::set_precision_bits),
              Entry(&T::regimes, &P::regimes, &P::mutable_regimes), Entry(&T::is_set, &P::is_set, &P::set_is_set),
              Entry(&T::numbers, &P::numbers, &P::mutable_numbers)>;
};

void ToProto(const Certificate& certificate, v1::Certificate& proto) {
  Map<Certificate>::Fields::Write(certificate, proto);
}
void FromProto(const v1::Certificate& proto, Certificate& certificate) {
  Map<Certificate>::Fields::Read(proto, certificate);
}

}  // namespace ricochet
