#include "hal/can/can_socket.hpp"

#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <linux/ethtool.h>
#include <linux/sockios.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <vector>

namespace stiction::hal::can {
namespace {

constexpr std::int64_t second_ns = 1'000'000'000;

std::int64_t clock_ns(clockid_t clock) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return now.tv_sec * second_ns + now.tv_nsec;
}

[[noreturn]] void fail(const std::string& interface, const std::string& what) {
  throw CanError("can: " + interface + ": " + what);
}

std::string can_interfaces() {
  constexpr int arphrd_can = 280;  // linux/if_arp.h
  std::string names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/sys/class/net", error)) {
    int type = 0;
    std::ifstream(entry.path() / "type") >> type;
    if (type == arphrd_can) names += (names.empty() ? "" : ", ") + entry.path().filename().string();
  }
  return names.empty() ? "none" : names;
}

unsigned index_of(const std::string& interface) {
  const unsigned index = ::if_nametoindex(interface.c_str());
  if (index == 0)
    fail(interface, "found no such network interface; expected a CAN interface (there is: " + can_interfaces() +
                        "); a virtual one: ip link add " + interface + " type vcan");
  return index;
}

void expect_up(int descriptor, const std::string& interface, Format format) {
  ifreq request{};
  interface.copy(request.ifr_name, IFNAMSIZ - 1);
  if (::ioctl(descriptor, SIOCGIFFLAGS, &request) != 0) fail(interface, std::strerror(errno));
  if ((request.ifr_flags & IFF_UP) == 0)
    fail(interface, "found the interface down; expected it up: ip link set " + interface +
                        " up (a real one with its bit rate: ip link set " + interface + " type can bitrate 1000000)");
  if (::ioctl(descriptor, SIOCGIFMTU, &request) != 0) fail(interface, std::strerror(errno));
  if (format == Format::fd && request.ifr_mtu < static_cast<int>(CANFD_MTU))
    fail(interface, "found an interface for classical frames (mtu " + std::to_string(request.ifr_mtu) +
                        "); expected one for CAN FD: ip link set " + interface + " mtu 72, or type can ... fd on");
}

void set(int descriptor, const std::string& interface, int level, int option, const void* value, std::size_t size) {
  if (::setsockopt(descriptor, level, option, value, static_cast<socklen_t>(size)) != 0)
    fail(interface, std::string("a socket option was refused: ") + std::strerror(errno));
}

}  // namespace

CanSocket::CanSocket(const std::string& interface, Format format, std::span<const Filter> filters, bool errors)
    : index_file_("/sys/class/net/" + interface + "/ifindex"), format_(format) {
  if (interface.empty() || interface.size() >= IFNAMSIZ)
    fail(interface, "found a name of " + std::to_string(interface.size()) + " characters; expected 1 to 15");
  index_ = static_cast<int>(index_of(interface));
  descriptor_ = ::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
  if (descriptor_ < 0)
    fail(interface,
         std::string("no CAN socket: ") + std::strerror(errno) + "; expected a kernel with CAN (modprobe can_raw)");
  try {
    expect_up(descriptor_, interface, format);
    for (const auto& f : filters)
      filters_.push_back({f.id | (f.inverted ? CAN_INV_FILTER : 0u), f.mask | CAN_EFF_FLAG | CAN_RTR_FLAG});
    const int on = 1;
    const bool all = std::any_of(filters.begin(), filters.end(), [](const Filter& f) { return f.inverted; });
    if (all) set(descriptor_, interface, SOL_CAN_RAW, CAN_RAW_JOIN_FILTERS, &on, sizeof on);
    // A bus may carry FD frames of others, which a watch must see too.
    if (format == Format::fd) set(descriptor_, interface, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on);
    const can_err_mask_t classes = errors ? CAN_ERR_MASK : 0u;
    set(descriptor_, interface, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &classes, sizeof classes);
    set(descriptor_, interface, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
    set(descriptor_, interface, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);
    if (!bind(index_)) fail(interface, std::string("cannot be bound: ") + std::strerror(errno));
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

CanSocket::~CanSocket() { ::close(descriptor_); }

// The kernel drops the filters together with an interface that goes (net/can/raw.c, raw_notify).
bool CanSocket::bind(int index) const {
  if (::setsockopt(descriptor_, SOL_CAN_RAW, CAN_RAW_FILTER, filters_.data(),
                   static_cast<socklen_t>(filters_.size() * sizeof(can_filter))) != 0)
    return false;
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = index;
  return ::bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
}

// The kernel never gives an index twice: one with the same number is the same interface. Read from sysfs, as the ioctl
// for it (SIOCGIFINDEX) has the kernel look for a module where there is no interface, which held the loop up for
// seconds.
bool CanSocket::find_again() {
  const int file = ::open(index_file_.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  std::array<char, 16> digits{};
  const ssize_t size = ::read(file, digits.data(), digits.size());
  ::close(file);
  int index = 0;
  if (size <= 0 || std::from_chars(digits.data(), digits.data() + size, index).ec != std::errc{}) return false;
  if (index == index_) return true;
  if (!bind(index)) return false;
  index_ = index;
  return true;
}

bool CanSocket::send(const Frame& frame, Format format) {
  canfd_frame wire{};
  wire.can_id = frame.id;
  wire.len = frame.size;
  if (format == Format::fd) wire.flags = CANFD_BRS;
  std::copy_n(frame.data.begin(), frame.size, wire.data);
  const std::size_t size = format == Format::fd ? CANFD_MTU : CAN_MTU;
  ssize_t sent = 0;
  do sent = ::send(descriptor_, &wire, size, MSG_DONTWAIT);
  while (sent < 0 && errno == EINTR);
  return sent == static_cast<ssize_t>(size);
}

bool CanSocket::take(Received& received) {
  canfd_frame wire;
  iovec part{&wire, sizeof wire};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(timespec)) + CMSG_SPACE(sizeof(std::uint32_t))> control;
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  ssize_t size = 0;
  do size = ::recvmsg(descriptor_, &message, MSG_DONTWAIT);
  while (size < 0 && errno == EINTR);
  if (size != static_cast<ssize_t>(CAN_MTU) && size != static_cast<ssize_t>(CANFD_MTU)) return false;

  received.error = (wire.can_id & CAN_ERR_FLAG) != 0;
  received.frame.id = wire.can_id & (received.error ? CAN_ERR_MASK : CAN_EFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG);
  received.frame.size = std::min<std::uint8_t>(wire.len, size == static_cast<ssize_t>(CAN_MTU) ? 8 : 64);
  std::copy_n(wire.data, received.frame.size, received.frame.data.begin());
  for (cmsghdr* part_of = CMSG_FIRSTHDR(&message); part_of != nullptr; part_of = CMSG_NXTHDR(&message, part_of)) {
    if (part_of->cmsg_level != SOL_SOCKET) continue;
    if (part_of->cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t lost = 0;
      std::memcpy(&lost, CMSG_DATA(part_of), sizeof lost);
      lost_in_kernel_ = lost;
    } else if (part_of->cmsg_type == SCM_TIMESTAMPNS) {
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(part_of), sizeof stamp);
      // The kernel stamps with the time of day, which may be set at any time: only its distance from now is used.
      const std::int64_t age = clock_ns(CLOCK_REALTIME) - (stamp.tv_sec * second_ns + stamp.tv_nsec);
      received.received_ns = clock_ns(CLOCK_MONOTONIC) - std::clamp<std::int64_t>(age, 0, second_ns);
    }
  }
  return true;
}

bool CanSocket::receive(Received& received, std::int64_t deadline_ns) {
  for (;;) {
    if (take(received)) return true;
    const std::int64_t left = deadline_ns == 0 ? 0 : deadline_ns - clock_ns(CLOCK_MONOTONIC);
    if (left <= 0) return false;
    pollfd wanted{descriptor_, POLLIN, 0};
    const timespec timeout{left / second_ns, left % second_ns};
    if (::ppoll(&wanted, 1, &timeout, nullptr) == 0) return false;
    if ((wanted.revents & (POLLERR | POLLHUP)) != 0) return take(received);  // the interface went down
  }
}

bool is_virtual(const std::string& interface) {
  // A serial line's slcan is a virtual device with a real bus: the driver's name tells.
  ethtool_drvinfo driver{};
  driver.cmd = ETHTOOL_GDRVINFO;
  ifreq request{};
  interface.copy(request.ifr_name, IFNAMSIZ - 1);
  request.ifr_data = reinterpret_cast<char*>(&driver);
  const int descriptor = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const bool known = ::ioctl(descriptor, SIOCETHTOOL, &request) == 0;
  ::close(descriptor);
  const std::string_view name = driver.driver;
  return known && (name == "vcan" || name == "vxcan");
}

}  // namespace stiction::hal::can
