// SPDX-License-Identifier: Apache-2.0
// @ts-check
/** What the program sends, made from examples by src/apps/server/messages_test.cpp. */

/** @typedef {{result: any, state: {can_close: boolean, done: number, folder: string, history: {done: boolean, enabled: boolean, id: string, name?: string, op: string, params: any, report: any, set_aside?: boolean, strokes?: number}[], mode: string, name: string, note: string, packs: {coarse: string, light: string, look: string, shape: string, tables: string, vertex_light: string}, parts: {edit: string, name: string, points: number, share: number}[], program: string, read_only: boolean, revision: string}}} Changed */
/** @typedef {{error: string, type: string}} ErrorNews */
/** @typedef {{error: string}} Failure */
/** @typedef {{seconds: number, seq: number, type: string}} FrameNews */
/** @typedef {{center: [number, number, number], material: {exposures: number, focal: number, light: {motion: string}, metal_share: number, metalness: number, refined_poses: number, roughness: number, roughness_range: number[], specular: number, varies: boolean}, presets: string[], radius: number, segment: boolean, start: {camera: {center: [number, number, number], cx: number, cy: number, fx: number, fy: number, height: number, skew: number, width: number, world_from_cam: [number, number, number][]}, view: string}, summary: string, up: [number, number, number], views: {camera: {center: [number, number, number], cx: number, cy: number, fx: number, fy: number, height: number, skew: number, width: number, world_from_cam: [number, number, number][]}, name: string, photo: boolean, split: string}[], warning: string}} ObjectInfo */
/** @typedef {{albedo: string, depth: number, metalness: number, normal: [number, number, number], parts: string[], position: [number, number, number], roughness: number, specular: number}} Picked */
/** @typedef {{part: string, report: any, token: string}} Preview */
/** @typedef {{event: number, fraction: number, job: string, message: string, seconds_left: number, stage: string, type: string}} ProgressNews */
/** @typedef {{can_close: boolean, done: number, folder: string, history: {done: boolean, enabled: boolean, id: string, name?: string, op: string, params: any, report: any, set_aside?: boolean, strokes?: number}[], mode: string, name: string, note: string, packs: {coarse: string, light: string, look: string, shape: string, tables: string, vertex_light: string}, parts: {edit: string, name: string, points: number, share: number}[], program: string, read_only: boolean, revision: string}} ProjectState */
/** @typedef {{event?: number, mode: string, revision: string, type: string}} StateNews */
/** @typedef {{frame: number[], height: number, packed: boolean, samples: number, seq: number, width: number, x: number, y: number}} TileHead */
/** @typedef {{complete: boolean, event: number, run: string, type: string}} Welcome */
export {};
