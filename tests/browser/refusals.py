#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""refusals.py PROGRAM OBJECT FOLDER: requests that `cei3d open` must refuse, sent by a client that is not a browser."""
import http.client
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import time


def start(program, project):
    process = subprocess.Popen([program, 'open', project, '--no-browser', '--port', '0', '--json'],
                               stdout=subprocess.PIPE, text=True)
    text = ''
    while not text.rstrip().endswith('}'):
        line = process.stdout.readline()
        if not line:
            raise SystemExit('FAILED: cei3d open ended')
        text += line
    url = json.loads(text)['url']
    check('the address', url.startswith('http://127.0.0.1:'), True)  # a name could lead to another user's program
    return process, int(url.split(':')[2].split('/')[0]), url.split('k=')[1]


class Client:
    def __init__(self, port, token):
        self.port, self.token = port, token

    def ask(self, method, path, body=None, **headers):
        connection = http.client.HTTPConnection('127.0.0.1', self.port, timeout=30)
        defaults = {'Host': f'localhost:{self.port}', 'Authorization': f'Bearer {self.token}'}
        if method == 'POST':
            defaults['Content-Type'] = 'application/json'
        defaults.update({k.replace('_', '-'): v for k, v in headers.items()})
        connection.putrequest(method, path, skip_host=True)
        for k, v in defaults.items():
            if v is not None:
                connection.putheader(k, v)
        if body is not None:
            connection.putheader('Content-Length', str(len(body)))
        connection.endheaders(body)
        response = connection.getresponse()
        data = response.read()
        connection.close()
        return response.status, data, response.headers


def contents(folder):
    """Files and their bytes, without those of cache/ and the lock file, which the program may write at any time."""
    found = {}
    for root, folders, files in os.walk(folder):
        if root == folder and 'cache' in folders:
            folders.remove('cache')
        for f in set(files) - {'.lock'}:
            path = os.path.join(root, f)
            found[path] = open(path, 'rb').read()
    return found


def check(what, got, *wanted):
    if got not in wanted:
        raise SystemExit(f'FAILED: {what}: {got}, expected {wanted}')


POSTS = ['edit', 'preview', 'commit', 'pick', 'mask', 'undo', 'redo', 'toggle', 'goto', 'rename', 'restore', 'forget',
         'export', 'turntable', 'open', 'close', 'reconstruct', 'cancel', 'decal', 'step', 'upload?name=x']
GETS = ['state', 'start', 'object', 'making', 'photo/train/r_000', 'download/x', 'pack/shape']
FORMS = ['application/x-www-form-urlencoded', 'multipart/form-data; boundary=x', 'text/plain', None]  # what a page of another site can send


def refused_everywhere(client):
    foreign = f'http://evil.example:{client.port}'
    cases = [({'Authorization': None}, 401), ({'Authorization': 'Bearer ' + '0' * 64}, 401),
             ({'Host': 'evil.example'}, 403), ({'Origin': foreign}, 403), ({'Origin': 'null'}, 403),
             ({'Sec_Fetch_Site': 'cross-site'}, 403)]
    for method, paths in (('GET', GETS), ('POST', POSTS)):
        for path in paths:
            for headers, status in cases:
                check(f'{method} {path} with {headers}', client.ask(method, '/api/' + path, b'{}', **headers)[0], status)
    for path in POSTS:
        for kind in FORMS:
            check(f'{kind} to {path}', client.ask('POST', '/api/' + path, b'a=1', Content_Type=kind)[0], 415)
    for method in ('PUT', 'DELETE', 'OPTIONS', 'PATCH'):
        check(method, client.ask(method, '/api/state')[0], 405)


def odd_paths(client):
    for path in ('/app/../../etc/passwd', '//etc/passwd', '/api/download/project.json', '/api/photo/%ff%fe',
                 '/api/' + 'a' * 4000, '/api/nothing'):
        check(path[:60], client.ask('GET', path)[0], 400, 404, 422)
    # Paths that lead one folder up from every place below which there are files, or could be.
    for prefix in ['/', '/app/', '/app/editor/', '/api/'] + [f'/api/{g.split("/")[0]}/' for g in GETS]:
        for up in ('..%2f', '..%2f..%2f', '../', '%2e%2e/', '..%5c', '%2e%2e%2f..%2f'):
            status, body, _ = client.ask('GET', f'{prefix}{up}project.json')
            check(f'{prefix}{up}', status, 400, 404, 422)
            assert b'"normalization"' not in body, 'a file of the project was sent'


def state_when_it_answers(client):
    """The program refuses more than 64 connections at once, and takes a moment to notice that some are closed."""
    deadline = time.monotonic() + 20
    while True:
        try:
            return client.ask('GET', '/api/state')[0]
        except (ConnectionError, http.client.HTTPException):
            if time.monotonic() > deadline:
                raise
        time.sleep(0.05)


def too_much(client):
    check('long headers', client.ask('GET', '/', None, X_Long='a' * 100000)[0], 431)
    for path in POSTS:  # is refused before it is sent
        size = 257 << 20 if path.startswith('upload') else (4 << 20) + 1
        check(f'long body to {path}', client.ask('POST', '/api/' + path, None, Content_Length=str(size))[0], 413)
    check('long body', client.ask('POST', '/api/edit', b'{' + b' ' * (5 << 20) + b'}')[0], 413)
    check('broken JSON', client.ask('POST', '/api/edit', b'{"op"')[0], 400)
    many = [socket.create_connection(('127.0.0.1', client.port)) for _ in range(100)]  # says nothing
    for s in many:
        s.close()
    check('after 100 silent connections', state_when_it_answers(client), 200)


def bad_sockets(client):
    upgrade = {'Connection': 'Upgrade', 'Upgrade': 'websocket', 'Sec-WebSocket-Key': 'AAAAAAAAAAAAAAAAAAAAAA==',
               'Sec-WebSocket-Version': '13'}
    headers = {k.replace('-', '_'): v for k, v in upgrade.items()}
    check('socket from another page', client.ask('GET', '/socket', None, Origin='http://evil.example', **headers)[0], 403)
    check('socket of another host', client.ask('GET', '/socket', None, Host='evil.example', **headers)[0], 403)
    silent_socket(client, upgrade)


def silent_socket(client, upgrade):
    """A socket without the key is closed, so that it does not use up a connection."""
    s = socket.create_connection(('127.0.0.1', client.port), timeout=60)
    lines = [f'GET /socket HTTP/1.1\r\nHost: 127.0.0.1:{client.port}'] + [f'{k}: {v}' for k, v in upgrade.items()]
    s.sendall('\r\n'.join(lines + ['', '']).encode())
    asked = time.monotonic()
    try:
        check('a silent socket opens', s.recv(1 << 16).split()[1], b'101')
        while s.recv(1 << 16):
            pass
    except ConnectionError:
        pass
    except TimeoutError:
        raise SystemExit('FAILED: a silent socket stays open')
    check('a silent socket is closed soon', time.monotonic() - asked < 4.5, True)  # after 2 s


def main(program, object_folder, folder):
    project = os.path.join(folder, 'object')
    shutil.copytree(object_folder, project)
    process, port, token = start(program, project)
    try:
        client = Client(port, token)
        status, page, headers = client.ask('GET', '/', None, Authorization=None)
        check('page', status, 200)
        assert b'<script type="module"' in page and token.encode() not in page
        assert "default-src 'none'" in headers['Content-Security-Policy'] and headers['X-Content-Type-Options'] == 'nosniff'
        assert not any(k.lower().startswith('access-control') for k in headers)
        check('same file again', client.ask('GET', '/', None, If_None_Match=headers['ETag'])[0], 304)
        while json.loads(client.ask('GET', '/api/state')[1])['mode'] == 'opening':
            pass
        before = contents(project)
        refused_everywhere(client)
        odd_paths(client)
        too_much(client)
        bad_sockets(client)
        assert contents(project) == before, 'something was changed'
        second = subprocess.run([program, 'undo', project], capture_output=True, text=True)
        check('a second writer', second.returncode, 1)
        assert 'in use by another' in second.stderr and f'http://127.0.0.1:{port};' in second.stderr
        assert token not in second.stderr
        refusal = subprocess.run([program, 'open', project, '--host', '0.0.0.0'], capture_output=True, text=True)
        check('an open address', refusal.returncode, 2)
        process.send_signal(signal.SIGINT)
        check('Ctrl-C', process.wait(20), 0)
    finally:
        process.kill()


if __name__ == '__main__':
    main(*sys.argv[1:])
