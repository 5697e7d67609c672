//! Builds the page and serves it: `cargo run --release -p raydsl-web --bin serve`, or with an
//! address, as `-- 127.0.0.1:9000`.

#[cfg(not(target_family = "wasm"))]
fn main() -> std::process::ExitCode {
    use std::process::ExitCode;
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("serve: {message}");
            ExitCode::from(2)
        }
    }
}

#[cfg(not(target_family = "wasm"))]
fn run() -> Result<(), String> {
    use raydsl_web::bundle::bundle;
    use raydsl_web::server::PageServer;

    let address = std::env::args().nth(1).unwrap_or_else(|| "127.0.0.1:8000".to_owned());
    let address = address.parse().map_err(|e| format!("{address}: {e}; as in 127.0.0.1:8000"))?;
    let folder = bundle().map_err(|e| e.to_string())?;
    let server = PageServer::open(&folder, address)?;
    println!("{}", server.url());
    server.serve(None);
    Ok(())
}

#[cfg(target_family = "wasm")]
fn main() {}
