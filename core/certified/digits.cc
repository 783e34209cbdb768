#include "core/certified/digits.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "absl/strings/str_cat.h"
#include "core/certified/flint.h"
#include "core/numerics/elementary.h"

namespace ricochet::certified {
namespace {

constexpr double kBitsPerDigit = 3.3219280948873626;

class Integer {
 public:
  Integer() { fmpz_init(value_); }
  Integer(const Integer& other) { fmpz_init_set(value_, other.value_); }
  Integer& operator=(const Integer&) = delete;
  ~Integer() { fmpz_clear(value_); }
  static Integer PowerOfTen(int64_t exponent) {
    Integer power;
    fmpz_ui_pow_ui(power.value_, 10, static_cast<ulong>(exponent));
    return power;
  }
  friend bool operator<(const Integer& x, const Integer& y) { return fmpz_cmp(x.value_, y.value_) < 0; }
  std::string ToString() const {
    char* const text = fmpz_get_str(nullptr, 10, value_);
    std::string copy(text);
    flint_free(text);
    return copy;
  }
  fmpz* get() { return value_; }
  const fmpz* get() const { return value_; }

 private:
  fmpz_t value_;
};

// Returns x 10^power.
Rational Scaled(const Rational& x, int64_t power) {
  Rational scale(1.0);
  const Integer ten = Integer::PowerOfTen(power >= 0 ? power : -power);
  fmpz_set(power >= 0 ? fmpq_numref(scale.get()) : fmpq_denref(scale.get()), ten.get());
  return x * scale;
}

Surd Scaled(const Surd& x, int64_t power) { return x * Surd(Scaled(Rational(1.0), power)); }

// Sets `ball` to enclose the number.
void Enclose(const Number<Surd>& number, slong bits, Ball& ball) {
  number.value.Enclose(ball.get(), bits);
  if (number.is_square) arb_sqrt(ball.get(), ball.get(), bits);
}

Number<Surd> Scaled(const Number<Surd>& number, int64_t power) {
  return {Scaled(number.value, number.is_square ? 2 * power : power), number.is_square};
}

enum class Rounding { kNearest, kDown, kUp };

struct Rounded {
  Integer digits;
  bool is_exact = false;
};

// Rounds x >= 0 to an integer.
Rounded Round(const Rational& x, Rounding rounding) {
  Rounded rounded;
  Integer remainder;
  fmpz_fdiv_qr(rounded.digits.get(), remainder.get(), fmpq_numref(x.get()), fmpq_denref(x.get()));
  rounded.is_exact = fmpz_is_zero(remainder.get()) != 0;
  fmpz_mul_2exp(remainder.get(), remainder.get(), 1);
  const int against_half = fmpz_cmp(remainder.get(), fmpq_denref(x.get()));
  const bool is_odd = fmpz_is_odd(rounded.digits.get()) != 0;
  const bool nearest_is_up = against_half > 0 || (against_half == 0 && is_odd);
  if (rounding == Rounding::kNearest ? nearest_is_up : rounding == Rounding::kUp && !rounded.is_exact) {
    fmpz_add_ui(rounded.digits.get(), rounded.digits.get(), 1);
  }
  return rounded;
}

// Returns the sign of x - h for x, h >= 0.
int Compare(const Number<Surd>& x, const Integer& h) {
  Rational exact;
  fmpz_set(fmpq_numref(exact.get()), h.get());
  return (x.value - Surd(x.is_square ? exact * exact : exact)).Sign();
}

// Rounds an irrational x > 0 to the nearest integer, which it gets from the floor of 2 x.
Rounded RoundIrrational(const Number<Surd>& x, slong bits) {
  const Number<Surd> twice = {x.value * Surd(x.is_square ? 4.0 : 2.0), x.is_square};
  Ball ball;
  Enclose(twice, bits, ball);
  Rounded rounded;
  const ArfInterval ends(ball.get(), bits);
  arf_get_fmpz(rounded.digits.get(), ends.lower().get(), ARF_RND_FLOOR);
  Integer upper;
  arf_get_fmpz(upper.get(), ends.upper().get(), ARF_RND_FLOOR);
  while (rounded.digits < upper) {
    Integer next(rounded.digits);
    fmpz_add_ui(next.get(), next.get(), 1);
    if (Compare(twice, next) < 0) break;
    fmpz_set(rounded.digits.get(), next.get());
  }
  fmpz_add_ui(rounded.digits.get(), rounded.digits.get(), 1);
  fmpz_fdiv_q_2exp(rounded.digits.get(), rounded.digits.get(), 1);
  return rounded;
}

Rounded Round(const Number<Surd>& x, int digits, Rounding rounding) {
  if (x.value.IsRational() && !x.is_square) return Round(x.value.rational_part(), rounding);
  return RoundIrrational(x, BitsOf(digits));
}

// Returns floor(log10 |x|) for x != 0, or an integer next to it.
int64_t DecimalExponent(const arf_struct* x) {
  Integer mantissa_exponent;
  Arf mantissa;
  arf_frexp(mantissa.get(), mantissa_exponent.get(), x);
  const double log2 = Log(std::fabs(arf_get_d(mantissa.get(), ARF_RND_NEAR))) * std::numbers::log2e +
                      static_cast<double>(fmpz_get_si(mantissa_exponent.get()));
  return static_cast<int64_t>(std::floor(log2 / kBitsPerDigit));
}

// Writes the digits with an exponent only where the plain form would need zeros that are no digits of the number.
std::string Spell(bool negative, std::string digits, int64_t exponent, bool is_exact) {
  const auto count = static_cast<int64_t>(digits.size());
  const bool is_plain = exponent >= -6 && exponent < count;
  if (is_plain && exponent < 0) digits.insert(0, static_cast<size_t>(-exponent), '0');
  const size_t point = is_plain && exponent > 0 ? static_cast<size_t>(exponent) + 1 : 1;
  if (is_exact) digits.erase(std::max(digits.find_last_not_of('0') + 1, point));
  if (digits.size() > point) digits.insert(point, 1, '.');
  return absl::StrCat(negative ? "-" : "", digits, is_plain ? "" : absl::StrCat("e", exponent));
}

struct Decimal {
  std::string text = "0";
  bool is_exact = true;
};

// kDown rounds towards 0 and kUp away from it; only rational numbers may be rounded other than to the nearest.
Decimal ToDecimal(Number<Surd> number, int digits, Rounding rounding) {
  const int sign = number.value.Sign();
  if (sign == 0) return {};
  number.value = Abs(number.value);
  Ball ball;
  Enclose(number, BitsOf(digits), ball);
  int64_t exponent = DecimalExponent(arb_midref(ball.get()));
  const Integer least = Integer::PowerOfTen(digits - 1);
  const Integer too_many = Integer::PowerOfTen(digits);
  for (;; ++exponent) {
    Rounded rounded = Round(Scaled(number, digits - 1 - exponent), digits, rounding);
    if (rounded.digits < least) {
      exponent -= 2;
    } else if (rounded.digits < too_many) {
      return {Spell(sign < 0, rounded.digits.ToString(), exponent, rounded.is_exact), rounded.is_exact};
    }
  }
}

// Finds the nearest double with balls that shrink until both ends round to the same one. The first ball does, unless
// the number lies close to the middle of two doubles; if it lies exactly there the ball is exact.
double NearestDouble(const Number<Surd>& number) {
  constexpr slong kLeastBits = 128;
  constexpr slong kEnoughBits = 1 << 14;
  for (slong bits = kLeastBits;; bits *= 2) {
    Ball ball;
    Enclose(number, bits, ball);
    const ArfInterval ends(ball.get(), bits);
    const double lower = arf_get_d(ends.lower().get(), ARF_RND_NEAR);
    if (bits >= kEnoughBits || lower == arf_get_d(ends.upper().get(), ARF_RND_NEAR)) return lower + 0.0;
  }
}

Rational Exactly(const Arf& x) {
  Rational exact;
  arf_get_fmpq(exact.get(), x.get());
  return exact;
}

Number<Surd> AsNumber(const Arf& x) { return {Surd(Exactly(x)), false}; }

Arf Middle(const ArfInterval& interval) {
  constexpr slong kBits = 1 << 13;  // kMostCertifiedDigits take fewer.
  Arf sum;
  arf_add(sum.get(), interval.lower().get(), interval.upper().get(), kBits, ARF_RND_NEAR);
  arf_mul_2exp_si(sum.get(), sum.get(), -1);
  return sum;
}

double ToDouble(const Arf& x) { return arf_get_d(x.get(), ARF_RND_NEAR) + 0.0; }

std::string OutwardDecimal(const Arf& end, int digits, bool is_upper) {
  if (!end.IsFinite()) return end.Sign() < 0 ? "-inf" : "inf";
  const bool away_from_zero = (end.Sign() > 0) == is_upper;
  return ToDecimal(AsNumber(end), digits, away_from_zero ? Rounding::kUp : Rounding::kDown).text;
}

// Tells whether the interval is narrower than a millionth of a unit in the last digit, and in a double's last digit
// too.
bool IsNarrow(const ArfInterval& interval, int digits) {
  constexpr int kDigitsOfDouble = 17;
  if (interval.lower().Sign() * interval.upper().Sign() <= 0) return false;
  if (!interval.lower().IsFinite() || !interval.upper().IsFinite()) return false;
  Arf width;
  arf_sub(width.get(), interval.upper().get(), interval.lower().get(), 64, ARF_RND_UP);
  if (width.Sign() == 0) return true;
  Arf allowed;
  arf_mul_2exp_si(allowed.get(), interval.lower().get(), -BitsOf(std::max(digits, kDigitsOfDouble)) + 64 - 20);
  return arf_cmpabs(width.get(), allowed.get()) <= 0;
}

}  // namespace

slong BitsOf(int digits) { return static_cast<slong>(std::ceil(digits * kBitsPerDigit)) + 64; }

CertifiedNumber Certify(const Number<Surd>& given, int digits) {
  const bool has_rational_root = given.is_square && given.value.IsRational() && given.value.rational_part().IsSquare();
  const Number<Surd> number = has_rational_root ? Number<Surd>{Sqrt(given.value), false} : given;
  const Decimal decimal = ToDecimal(number, digits, Rounding::kNearest);
  return {.decimal = decimal.text, .value = NearestDouble(number), .exact = decimal.is_exact};
}

std::optional<CertifiedNumber> Certify(const ArfInterval& interval, int digits) {
  const bool is_point = interval.lower() == interval.upper();
  if (is_point && interval.lower().IsFinite()) return Certify(AsNumber(interval.lower()), digits);
  if (!IsNarrow(interval, digits)) return std::nullopt;
  const Arf middle = Middle(interval);
  const Decimal decimal = ToDecimal(AsNumber(middle), digits, Rounding::kNearest);
  return CertifiedNumber{.decimal = decimal.text, .value = ToDouble(middle)};
}

CertifiedNumber CertifyRange(const ArfInterval& interval, int digits) {
  return {.lower = OutwardDecimal(interval.lower(), digits, false),
          .upper = OutwardDecimal(interval.upper(), digits, true),
          .value = ToDouble(Middle(interval))};
}

}  // namespace ricochet::certified
