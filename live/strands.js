// Many straight pieces of tubes in one draw call: each is a ribbon that turns its side to the camera, shaded as a tube.
import * as three from 'three';

const vertex = `
  attribute vec3 from; attribute vec3 to; attribute vec3 tint; attribute vec2 body; // body: radius, time of the last flash
  uniform float now;
  varying vec3 v_tint; varying vec3 v_place; varying float v_flash; varying float v_depth;
  void main() {
    vec3 a = (modelViewMatrix * vec4(from, 1.0)).xyz, b = (modelViewMatrix * vec4(to, 1.0)).xyz;
    float length_ab = distance(a, b), flash = exp(-max(0.0, now - body.y) * 3.0), radius = body.x * (1.0 + flash);
    vec3 along = length_ab > 1e-6 ? (b - a) / length_ab : vec3(1.0, 0.0, 0.0);
    vec3 side = cross(along, normalize(a + b));
    side = dot(side, side) > 1e-6 ? normalize(side) : normalize(cross(along, vec3(0.0, 1.0, 0.01)));
    vec3 place = (position.x < 0.5 ? a - along * radius : b + along * radius) + side * position.y * radius;
    v_tint = tint;
    v_flash = flash;
    v_place = vec3((position.x < 0.5 ? -1.0 : length_ab / radius + 1.0), position.y, length_ab / radius);
    v_depth = -place.z;
    gl_Position = projectionMatrix * vec4(place, 1.0);
  }`;

const fragment = `
  uniform vec3 haze; uniform vec2 reach; uniform float opacity; uniform vec3 spark;
  varying vec3 v_tint; varying vec3 v_place; varying float v_flash; varying float v_depth;
  void main() {
    float past = v_place.x - clamp(v_place.x, 0.0, v_place.z), across = past * past + v_place.y * v_place.y;
    if (across > 1.0) discard;
    float light = 0.42 + 0.58 * sqrt(1.0 - v_place.y * v_place.y * 0.92);
    vec3 color = mix(v_tint * light, spark, clamp(v_flash, 0.0, 1.0));
    float far = clamp((v_depth - reach.x) / (reach.y - reach.x), 0.0, 1.0);
    gl_FragColor = vec4(mix(color, haze, far * 0.62), opacity);
  }`;

const corners = new Float32Array([0, -1, 0, 1, -1, 0, 1, 1, 0, 0, 1, 0]);

export class Strands {
  /** room: pieces at most; opacity below 1: drawn through each other, without shadowing. */
  constructor(room, opacity = 1) {
    const geometry = new three.InstancedBufferGeometry();
    geometry.setAttribute('position', new three.BufferAttribute(corners, 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    this.ends = new three.InstancedInterleavedBuffer(new Float32Array(room * 6), 6);
    this.ends.setUsage(three.DynamicDrawUsage);
    geometry.setAttribute('from', new three.InterleavedBufferAttribute(this.ends, 3, 0));
    geometry.setAttribute('to', new three.InterleavedBufferAttribute(this.ends, 3, 3));
    this.tint = new three.InstancedBufferAttribute(new Float32Array(room * 3), 3);
    this.body = new three.InstancedBufferAttribute(new Float32Array(room * 2).fill(-1e6), 2);
    geometry.setAttribute('tint', this.tint);
    geometry.setAttribute('body', this.body);
    geometry.instanceCount = 0;
    this.room = room;
    this.material = new three.ShaderMaterial({vertexShader: vertex, fragmentShader: fragment, side: three.DoubleSide,
      transparent: opacity < 1, depthWrite: opacity >= 1,
      uniforms: {now: {value: 0}, haze: {value: new three.Vector3()}, reach: {value: new three.Vector2(1, 2)}, opacity: {value: opacity}, spark: {value: new three.Vector3(1, 1, 1)}}});
    this.mesh = new three.Mesh(geometry, this.material);
    this.mesh.frustumCulled = false;
  }

  set count(pieces) { this.mesh.geometry.instanceCount = pieces; }
  get count() { return this.mesh.geometry.instanceCount; }

  /** Color [r, g, b] and radius of piece `at`. */
  paint(at, color, radius) {
    this.tint.array.set(color, 3 * at);
    this.body.array[2 * at] = radius;
    this.tint.needsUpdate = this.body.needsUpdate = true;
  }

  flash(at, now) {
    this.body.array[2 * at + 1] = now;
    this.body.needsUpdate = true;
  }

  /** After the ends have changed. */
  moved() { this.ends.needsUpdate = true; }

  dispose() {
    this.mesh.geometry.dispose();
    this.material.dispose();
  }
}

/** Folds places into the box; in a sheared box the images above and below are shifted along x by `offset`. */
export class Fold {
  constructor(cells, walled) { this.cells = cells; this.walled = walled; this.offset = 0; this.shift = [0, 0, 0]; }

  /** Sets `shift` to what takes a place into the box. */
  find(x, y, z) {
    const [lx, ly, lz] = this.cells, rows = this.walled ? 0 : Math.floor(y / ly), moved = x - rows * this.offset;
    this.shift[0] = -rows * this.offset - Math.floor(moved / lx) * lx;
    this.shift[1] = -rows * ly;
    this.shift[2] = -Math.floor(z / lz) * lz;
    return this.shift;
  }
}
