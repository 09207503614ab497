#include "sensors/live/serial_port.h"

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace maploop::sensors {
namespace {

constexpr std::array<std::pair<int, speed_t>, 12> rates{{{4800, B4800},
                                                         {9600, B9600},
                                                         {19200, B19200},
                                                         {38400, B38400},
                                                         {57600, B57600},
                                                         {115200, B115200},
                                                         {230400, B230400},
                                                         {460800, B460800},
                                                         {500000, B500000},
                                                         {921600, B921600},
                                                         {1000000, B1000000},
                                                         {2000000, B2000000}}};

speed_t speed_of(int baud) {
  for (const auto& [rate, speed] : rates) {
    if (rate == baud) return speed;
  }
  return B0;
}

}  // namespace

bool is_baud_rate(int baud) {
  return speed_of(baud) != B0;
}

int open_serial(const std::string& device, int baud, std::string& problem) {
  const int fd = open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) {
    const int error = errno;
    problem = std::string("cannot be opened: ") + std::strerror(error) +
              (error == EACCES   ? "; is this user in the group dialout?"
               : error == ENOENT ? "; is it plugged in?"
                                 : "");
    return -1;
  }
  termios settings{};
  if (tcgetattr(fd, &settings) != 0) {
    problem = "is not a serial line";
    close(fd);
    return -1;
  }
  cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(CRTSCTS | CSTOPB);
  settings.c_cc[VMIN] = 1;  // with 0, an idle line looks like the end of a file
  settings.c_cc[VTIME] = 0;
  if (cfsetspeed(&settings, speed_of(baud)) != 0 || tcsetattr(fd, TCSANOW, &settings) != 0) {
    problem = "does not support " + std::to_string(baud) + " baud";
    close(fd);
    return -1;
  }
  tcflush(fd, TCIFLUSH);
  return fd;
}

}  // namespace maploop::sensors
