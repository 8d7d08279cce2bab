# SPDX-License-Identifier: Apache-2.0
# The page that shows an object, in a headless browser, against our own pictures of it.
source "$(dirname "$0")/lib.sh"

readonly project=$out/object
cp -r "$object" "$project"
cei3d edit "$project" part --view train/r_055 --mask "$sample/edits/paint/scribble.png" --name '<star>' \
  --color '#3c8c46' --metalness 1
cei3d export "$project" -o "$out/spot.html" --faces 60000
cei3d export "$project" -o "$out/again/spot.html" --faces 60000 --threads 1
same "$out/spot.html" "$out/again/spot.html"

# Its data, by another reader.
python3 - "$out/spot.html" <<'PYTHON'
import base64, gzip, json, re, struct, sys

text = open(sys.argv[1], encoding='utf-8').read()
blocks = dict(re.findall(r'<script id="data-(\w+)" type="application/octet-stream">([^<]*)</script>', text))
rows = {}
for kind in ('tables', 'light', 'shape', 'look', 'vertex_light', 'reflections'):
    data = gzip.decompress(base64.b64decode(blocks[kind]))
    size, = struct.unpack_from('<I', data)
    head = json.loads(data[4:4 + size])
    assert head['kind'] == kind
    for name, a in head['arrays'].items():
        width = int(a['type'][1:]) // 8
        assert a['at'] + width * a['shape'][0] * a['shape'][1] <= len(data) - 4 - size, name
        rows[name] = a['shape'][0]
    if kind == 'look':
        assert head['parts'] == ['', '<star>'], head['parts']
assert rows['positions'] == rows['normals'] == rows['albedo'] == rows['bounce'] > 10000, rows
assert 10000 < rows['triangles'] <= 60000, rows
assert '<star>' not in re.sub('<script.*?</script>', '', text, flags=re.S)
PYTHON

# The page has no correction network, and under a turned light the occlusion of the light that it was made for.
readonly views=(--turntable 3 --size 160x160 --no-residual)
cei3d render "$project" -o "$out/lit" "${views[@]}" --channels rgb,albedo
cei3d render "$project" -o "$out/turned" "${views[@]}" --env-rotate 45

command -v node >/dev/null || { echo "SKIP: the page in a browser: no node"; exit 77; }
node tools/check_page.cjs "$out/spot.html" "$out/lit" "$out/turned" --min 34
