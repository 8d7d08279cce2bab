#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""strokes.py PROGRAM PROJECT [STROKES [VIEWS]]: strokes on a copy of PROJECT by a client that is not a browser, but asks for what a page
asks for: packs, and two frames after each stroke. Prints times, and the memory of the program."""
import base64
import json
import math
import os
import random
import re
import shutil
import socket
import struct
import sys
import tempfile
import time
import zlib

from refusals import Client, check, start

WIDTH, HEIGHT, RADIUS, HARDNESS = 560, 480, 26, 0.8  # pixels


class Line:
    """The WebSocket of a window."""

    def __init__(self, client):
        self.socket = socket.create_connection(('127.0.0.1', client.port))
        self.bytes = b''
        self.number = 0
        host, key = f'localhost:{client.port}', base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(f'GET /socket HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n'
                            f'Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n'.encode())
        while b'\r\n\r\n' not in self.bytes:
            self.bytes += self.socket.recv(1 << 16)
        head, self.bytes = self.bytes.split(b'\r\n\r\n', 1)
        check('a WebSocket opens', head.split()[1], b'101')
        self.send({'type': 'hello', 'token': client.token})

    def send(self, message):
        data, mask = json.dumps(message).encode(), os.urandom(4)
        size = bytes([0x80 | len(data)]) if len(data) < 126 else bytes([0xfe]) + struct.pack('>H', len(data))
        self.socket.sendall(b'\x81' + size + mask + bytes(b ^ mask[i % 4] for i, b in enumerate(data)))

    def take(self, n):
        while len(self.bytes) < n:
            data = self.socket.recv(1 << 20)
            if not data:
                raise SystemExit('FAILED: the program closed the connection')
            self.bytes += data
        taken, self.bytes = self.bytes[:n], self.bytes[n:]
        return taken

    def receive(self):
        kind, size = self.take(2)
        size &= 127
        if size > 125:
            size = int.from_bytes(self.take(2 if size == 126 else 8), 'big')
        data = self.take(size)
        return json.loads(data) if kind & 15 == 1 else None

    def frame(self, camera, samples):
        self.number += 1
        self.send({'type': 'view', 'seq': self.number, 'camera': camera, 'samples': samples})
        while True:
            message = self.receive()
            if message and message['type'] == 'error':
                raise SystemExit(f'FAILED: {message}')
            if message and message['type'] == 'frame' and message['seq'] == self.number:
                return


def asked(client, method, path, body=None, **headers):
    if isinstance(body, dict):
        body = json.dumps(body).encode()
    status, data, _ = client.ask(method, '/api/' + path, body, **headers)
    if status != 200:
        raise SystemExit(f'FAILED: {path}: {status} {data[:300]}')
    return data


def dabs(places, color):
    """A PNG with a stroke of soft dabs."""
    def alpha(x, y):
        left = 1
        for u, v in places:
            distance = math.hypot(x + 0.5 - u, y + 0.5 - v) / RADIUS
            left *= 1 - min(1, max(0, (1 - distance) / (1 - HARDNESS)))
        return round(255 * (1 - left))

    rows = []
    (x0, x1), (y0, y1) = ((min(p[k] for p in places) - RADIUS, max(p[k] for p in places) + RADIUS) for k in (0, 1))
    for y in range(HEIGHT):
        row = bytearray(4 * WIDTH)
        for x in range(max(0, int(x0)), min(WIDTH, int(x1) + 1)) if y0 <= y <= y1 else ():
            if a := alpha(x, y):
                row[4 * x:4 * x + 4] = bytes([*color, a])
        rows.append(b'\0' + bytes(row))
    chunk = lambda name, data: struct.pack('>I', len(data)) + name + data + struct.pack('>I', zlib.crc32(name + data))
    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', WIDTH, HEIGHT, 8, 6, 0, 0, 0)) +
            chunk(b'IDAT', zlib.compress(b''.join(rows), 1)) + chunk(b'IEND', b''))


def of_size(camera):
    scale = min(WIDTH / camera['width'], HEIGHT / camera['height'])
    return {**camera, 'fx': camera['fx'] * scale, 'fy': camera['fy'] * scale, 'cx': WIDTH / 2, 'cy': HEIGHT / 2, 'width': WIDTH, 'height': HEIGHT}


def place(client, camera):
    """Somewhere on the object, not at its rim."""
    while True:
        x, y = WIDTH * random.uniform(0.2, 0.8), HEIGHT * random.uniform(0.2, 0.8)
        around = ((x - 8, y), (x + 20, y + 5), (x, y - 8), (x, y + 8))
        if all(json.loads(asked(client, 'POST', 'pick', {'camera': camera, 'pixel': p})) for p in around):
            return x, y


class Page:
    def __init__(self, client):
        self.client, self.line, self.have = client, Line(client), {}
        while (state := json.loads(asked(client, 'GET', 'state')))['mode'] != 'project':
            time.sleep(0.1)
        self.fetch(state)

    def fetch(self, state):
        for kind, key in state['packs'].items():
            if self.have.get(kind) != key:
                asked(self.client, 'GET', f'pack/{kind}?key={key}')
                self.have[kind] = key

    def look(self, camera):
        for samples in (1, 2):
            self.line.frame(camera, samples)

    def paint(self, camera):
        x, y = place(self.client, camera)
        png = dabs([(x + 3 * i, y + 1.2 * i) for i in range(5)], [random.randrange(256) for _ in range(3)])
        begin = time.time()
        scribble = json.loads(asked(self.client, 'POST', 'upload?name=scribble.png', png, Content_Type='application/octet-stream'))['id']
        answer = asked(self.client, 'POST', 'edit', {'op': 'paint', 'params': {'strokes': [{'camera': camera, 'scribble': scribble}]}})
        kept = time.time()
        self.fetch(json.loads(answer)['state'])
        self.look(camera)
        return kept - begin, time.time() - kept


def megabytes(pid):
    return int(re.search(r'VmRSS:\s*(\d+)', open(f'/proc/{pid}/status').read())[1]) / 1024


def main(program, original, strokes=1000, views=1):
    folder = tempfile.mkdtemp()
    project = os.path.join(folder, 'object')
    shutil.copytree(original, project)
    process, port, token = start(program, project)
    try:
        page = Page(Client(port, token))
        views_ = json.loads(asked(page.client, 'GET', 'object'))['views']
        cameras = [of_size(views_[k * len(views_) // views]['camera']) for k in range(views)]
        random.seed(1)
        page.look(cameras[0])
        print(f'| strokes | memory, MB | stroke kept, s | packs and two frames, s |\n|---|---|---|---|\n| 0 | {megabytes(process.pid):.0f} | | |', flush=True)
        step, times = max(1, strokes // 20), []
        for i in range(1, strokes + 1):
            times.append(page.paint(random.choice(cameras)))
            if i % step == 0:
                kept, shown = (sorted(t[k] for t in times)[len(times) // 2] for k in (0, 1))
                print(f'| {i} | {megabytes(process.pid):.0f} | {kept:.3f} | {shown:.3f} |', flush=True)
                times = []
        check('edits that are done', json.loads(asked(page.client, 'GET', 'state'))['done'], strokes)
    finally:
        process.kill()
        process.wait()
        shutil.rmtree(folder)


if __name__ == '__main__':
    main(*sys.argv[1:3], *(int(n) for n in sys.argv[3:]))
