declare module '@engine/engine.js' {
  const create: (options: { locateFile?: (name: string) => string; wasmBinary?: Uint8Array }) => Promise<unknown>;
  export default create;
}
