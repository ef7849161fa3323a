//! Temporary timing.
#![allow(clippy::print_stdout)]
use glam::Vec2;
use render::{cpu::Rasterizer, *};
fn main() {
    let (strands, joints) = (84u32, 19usize);
    let mut seed = 12345u32;
    let mut rnd = || {
        seed = seed.wrapping_mul(1664525).wrapping_add(1013904223);
        (seed >> 8) as f32 / (1 << 24) as f32
    };
    let n = strands as usize * joints;
    let mut d = Drawing {
        size: [960, 720],
        background: Some([1.0; 3]),
        ..Drawing::default()
    };
    let specs: [(&str, i32, usize, f32); 4] = [
        ("sil", -1, 1, 1.15),
        ("base", 0, 1, 1.0),
        ("cel", 1, 4, 0.25),
        ("hi", 2, 4, 0.2),
    ];
    let varying = std::env::args().any(|a| a == "varying");
    for (name, rank, inst, _) in specs {
        d.layers.push(LayerStrokes {
            name: name.into(),
            rank,
            instances: inst,
            discs: vec![
                Disc {
                    center: Vec2::ZERO,
                    radius: 0.0,
                    inv_depth: 1.0,
                    inv_depth_biased: 1.0
                };
                n * inst
            ],
            colors: vec![[0.1; 3]; n * inst],
        });
    }
    for s in 0..strands {
        let start = d.clump.len();
        d.runs.push(Run {
            strand: s,
            joints: start..start + joints,
        });
        let side = if s % 2 == 0 { -1.0 } else { 1.0 };
        let mut p = Vec2::new(480.0 + side * (20.0 + 60.0 * rnd()), 60.0 + 80.0 * rnd());
        let mut angle = 1.57 - side * (0.8 + 0.5 * rnd());
        let z = 2.0 + rnd() * 0.3;
        for j in 0..joints {
            let u = j as f32 / (joints - 1) as f32;
            let r = 11.0 * (3.14 * (0.3 + 0.7 * u)).sin().max(0.0);
            let w = 1.0 / (z - 0.1 * u);
            let biased = 1.0 / (z - 0.1 * u - 0.02);
            d.clump.push(Disc {
                center: p,
                radius: r,
                inv_depth: w,
                inv_depth_biased: biased,
            });
            let i = start + j;
            for (l, (_, _, inst, k)) in specs.iter().enumerate() {
                for f in 0..*inst {
                    let across = (f as f32 + 0.5) / *inst as f32 * 2.0 - 1.0;
                    let c = if *inst == 1 {
                        p
                    } else {
                        p + Vec2::from_angle(angle).perp() * across * r * 0.75
                    };
                    let active = *inst == 1 || (0.2..0.7).contains(&u);
                    let disc = &mut d.layers[l].discs[f * n + i];
                    *disc = Disc {
                        center: c,
                        radius: if active { r * k } else { 0.0 },
                        inv_depth: if l == 0 { w * 0.98 } else { w },
                        inv_depth_biased: biased,
                    };
                    if varying && l != 0 {
                        d.layers[l].colors[f * n + i] = [u, 0.5 * rnd(), l as f32 * 0.2];
                    } else {
                        d.layers[l].colors[f * n + i] =
                            [[0.0; 3], [0.05, 0.5, 0.5], [0.0, 0.3, 0.35], [1.0; 3]][l];
                    }
                }
            }
            p += Vec2::from_angle(angle) * (22.0 + 8.0 * rnd());
            angle += side * 0.09 * (1.0 + rnd() * 0.5);
        }
    }
    println!("segments {}", n * 11);
    for samples in [1, 4, 16] {
        for threads in [1, 2] {
            let mut r = Rasterizer::new(samples, Some(threads)).unwrap();
            let mut times: Vec<f64> = (0..20)
                .map(|_| {
                    let t = std::time::Instant::now();
                    std::hint::black_box(r.draw(&d).unwrap());
                    t.elapsed().as_secs_f64() * 1e3
                })
                .collect();
            times.sort_by(f64::total_cmp);
            println!(
                "{samples} samples, {threads} threads: min {:.2} median {:.2} ms",
                times[0], times[10]
            );
        }
    }
    let mut r = Rasterizer::new(4, Some(2)).unwrap();
    let p = r.draw(&d).unwrap();
    let t = std::time::Instant::now();
    let b = p.to_srgb8();
    println!("to_srgb8 {:.2} ms", t.elapsed().as_secs_f64() * 1e3);
    let mut ppm = b"P6\n960 720\n255\n".to_vec();
    ppm.extend(b.chunks(4).flat_map(|c| [c[0], c[1], c[2]]));
    std::fs::write("/tmp/perf.ppm", ppm).unwrap();
}
