#include "lidar_drivers/hesai/hesai_clock.hpp"

#include <chrono>

namespace hulltrack::hesai {

Nanoseconds read_clock(Bytes datagram, const ModelTable& model) {
  using namespace std::chrono;
  const Bytes date = datagram.subspan(model.tail_offset() + model.tail.date, kDateBytes);
  const year_month_day day{year(model.year_base + date[0]), month(date[1]), std::chrono::day(date[2])};
  const sys_days since = day.ok() ? sys_days(day) : sys_days{};
  // At most 2255-12-31 and some days of hours: 285 years, where 292 fit.
  return since.time_since_epoch() + hours(date[3]) + minutes(date[4]) + seconds(date[5]) +
         microseconds(read_le32(datagram, model.tail_offset() + model.tail.microseconds));
}

void write_clock(std::span<std::uint8_t> datagram, const ModelTable& model, Nanoseconds since_1970) {
  using namespace std::chrono;
  const sys_time<Nanoseconds> time{since_1970};
  const sys_days today = floor<days>(time);
  const year_month_day day(today);
  const hh_mm_ss clock(time - today);
  const std::span<std::uint8_t> date = datagram.subspan(model.tail_offset() + model.tail.date, kDateBytes);
  const int years = static_cast<int>(day.year()) - model.year_base;
  if (years >= 0) {
    date[0] = static_cast<std::uint8_t>(years);
    date[1] = static_cast<std::uint8_t>(static_cast<unsigned>(day.month()));
    date[2] = static_cast<std::uint8_t>(static_cast<unsigned>(day.day()));
  }
  date[3] = static_cast<std::uint8_t>(clock.hours().count());
  date[4] = static_cast<std::uint8_t>(clock.minutes().count());
  date[5] = static_cast<std::uint8_t>(clock.seconds().count());
  write_le32(datagram, model.tail_offset() + model.tail.microseconds,
             static_cast<std::uint32_t>(floor<microseconds>(clock.subseconds()).count()));
}

}  // namespace hulltrack::hesai
