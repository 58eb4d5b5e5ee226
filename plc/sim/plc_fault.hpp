// What can be wrong with the simulated PLC, one thing at a time.
#pragma once

namespace hulltrack::sim {

enum class PlcFault {
  none,
  // the connection
  refuse,      // connection refused; open ones are reset
  black_hole,  // a SYN gets no answer; open connections are silent
  pool_full,   // connections are accepted and closed at once; open ones are reset
  reset,       // a request is answered with a reset
  silent,      // requests are taken, nothing is answered
  // the reply
  late_reply,         // held back until the connection's next request has come, then sent before its reply
  wrong_transaction,  // another request's transaction id
  duplicate_reply,    // sent twice
  truncated_reply,    // its first half
  garbage_reply,      // random bytes, sometimes behind a correct header; the same ones in every run
  dribbled_reply,     // byte by byte, PlcServerConfig::dribble apart
  illegal_function,   // exception 01
  illegal_address,    // exception 02
  illegal_value,      // exception 03
  busy,               // exception 06
  write_refused,      // exception 02 to FC 16 only
  // the values in the read block
  frozen_heartbeat,  // joints still move
  torn_block,        // travel of the new cycle, the rest of the old one, tail copy behind (if there is one)
  torn_words,    // of travel, slew and luff the first register of the new cycle, the second of the old one
  not_a_number,  // travel, lowest raw value where the register is an integer
  infinite,      // travel
  out_of_range,  // travel 1 m beyond its maximum
};

}  // namespace hulltrack::sim
