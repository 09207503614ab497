// What `maploop ppp` writes into its page (tools/ppp/page_data.cpp). Times are seconds since the first epoch.
import type { Numbers } from "./plot";

export const statuses = ["none", "converging", "converged", "fixed"] as const;

export interface Solutions {
  time: number[]; // of epochs; where some are missing, one without a position
  status: string; // a digit for each, an index of `statuses`
  origin: [number, number, number]; // earth-fixed, m
  tracks: { name: string; x: Numbers; y: Numbers; z: Numbers }[]; // m from the origin; the first is the run's own
  sigma: [Numbers, Numbers, Numbers]; // of the first, east, north, up, m
}

export const quantities = ["cn0", "code", "phase", "ionosphere"] as const;
export type Quantity = (typeof quantities)[number];

export interface Satellite extends Record<Quantity, Numbers> {
  name: string;
  at: number[]; // indices of Satellites.time
  azimuth: number[]; // 0.1 degrees, as all of these whole numbers
  elevation: number[];
  // cn0: 0.1 dB-Hz; residuals of code and phase after the update, ionosphere's delay on GPS L1: mm
  spans: [from: number, to: number, state: number][]; // of all epochs
  slips: [time: number, reason: string][];
}

export interface Satellites {
  time: number[];
  states: string[]; // used with an integer ambiguity, in full, in part, and why not
  list: Satellite[];
}
