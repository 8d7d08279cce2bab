// SPDX-License-Identifier: Apache-2.0
// Plays a slow connection: a proxy that passes bytes on late and at a limited rate.
const net = require('node:net');

/** The bytes of one direction. They arrive in order, after the delay, and no faster than the rate. */
class Pipe {
  /** @param {import('node:net').Socket} from @param {import('node:net').Socket} to @param {{seconds: number, rate: number, free: number}} line shared by all pipes of its direction */
  constructor(from, to, line) {
    Object.assign(this, { from, to, line, waiting: 0 });
    from.on('data', (data) => this.take(data));
    from.on('end', () => this.at(Math.max(this.now(), this.line.free) + this.line.seconds, () => to.end()));
    from.on('error', () => to.destroy());
    from.on('close', () => { if (from.destroyed && !from.readableEnded) to.destroy(); });
  }

  now() { return performance.now() / 1000; }

  /** @param {number} moment @param {() => void} what */
  at(moment, what) { setTimeout(what, Math.max(0, 1000 * (moment - this.now()))); }

  /** @param {Buffer} data */
  take(data) {
    const kPiece = 8192, kMaxWaiting = 1 << 16;
    for (let begin = 0; begin < data.length; begin += kPiece) {
      const piece = data.subarray(begin, begin + kPiece);
      this.line.free = Math.max(this.now(), this.line.free) + piece.length / this.line.rate;
      this.waiting += piece.length;
      this.at(this.line.free + this.line.seconds, () => {
        this.waiting -= piece.length;
        this.to.write(piece);
        if (this.waiting < kMaxWaiting) this.from.resume();
      });
    }
    if (this.waiting >= kMaxWaiting) this.from.pause();  // as if buffers on the way were full
  }
}

/**
 * A proxy to a port of this machine. @param {number} port @param {{milliseconds: number, megabits: number}} line milliseconds: of the round trip; megabits: per second, in each direction
 * @returns {Promise<{port: number, close: () => void}>}
 */
function slowLine(port, { milliseconds, megabits }) {
  const way = () => ({ seconds: milliseconds / 2000, rate: megabits * 1e6 / 8, free: 0 });
  const up = way(), down = way();
  const server = net.createServer((near) => {
    const far = net.connect(port, '127.0.0.1');
    for (const socket of [near, far]) socket.setNoDelay(true);
    new Pipe(near, far, up);
    new Pipe(far, near, down);
  });
  return new Promise((resolve) => server.listen(0, '127.0.0.1', () => {
    resolve({ port: /** @type {any} */ (server.address()).port, close: () => server.close() });
  }));
}

module.exports = { slowLine };
