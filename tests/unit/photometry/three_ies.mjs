// What the IES reader of three.js finds in a file: node three_ies.mjs FOLDER_OF_THREE FILE
import { readFileSync } from 'node:fs';
const { IESLoader } = await import(process.argv[2] + '/examples/jsm/loaders/IESLoader.js');
const loader = new IESLoader();
loader._getIESValues = (lamp) => {
  console.log(lamp.verAngles.length, lamp.horAngles.length);
  for (const numbers of [lamp.verAngles, lamp.horAngles, ...lamp.candelaValues]) console.log(numbers.join(' '));
  return new Float32Array(180);
};
loader.parse(readFileSync(process.argv[3], 'utf8'));
